// Sources: PNG, third edition, sections 9.2 (filters) and 11.3.1.1 (tRNS).
#include "formats/picture/decode/png_rows.h"

#include <algorithm>
#include <cstdlib>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

std::uint8_t paeth(int left, int up, int corner) {
    const int to_left = std::abs(up - corner), to_up = std::abs(left - corner),
              to_corner = std::abs(left + up - 2 * corner);
    const int nearer = to_up <= to_corner ? up : corner;
    return static_cast<std::uint8_t>(to_left <= to_up && to_left <= to_corner ? left : nearer);
}

std::uint8_t sum(int a, int b) {
    return static_cast<std::uint8_t>(a + b);
}

// `up` is the row above, or zeros.
bool undo_filter(int kind, std::uint8_t* row, const std::uint8_t* up, std::size_t size, std::size_t step) {
    const std::size_t first = std::min(step, size);  // bytes with nothing on their left
    switch (kind) {
        case 0:
            return true;
        case 1:
            for (std::size_t i = first; i < size; ++i) row[i] = sum(row[i], row[i - step]);
            return true;
        case 2:
            for (std::size_t i = 0; i < size; ++i) row[i] = sum(row[i], up[i]);
            return true;
        case 3:
            for (std::size_t i = 0; i < first; ++i) row[i] = sum(row[i], up[i] / 2);
            for (std::size_t i = first; i < size; ++i) row[i] = sum(row[i], (row[i - step] + up[i]) / 2);
            return true;
        case 4:
            for (std::size_t i = 0; i < first; ++i) row[i] = sum(row[i], up[i]);
            for (std::size_t i = first; i < size; ++i)
                row[i] = sum(row[i], paeth(row[i - step], up[i], up[i - step]));
            return true;
        default:
            return false;
    }
}

}  // namespace

PngRows::PngRows(const PngParts& parts) : parts_(parts) {
    constexpr int kPalette = 1, kColor = 2, kAlpha = 4;
    const std::span<const std::uint8_t> clear = parts.transparency;
    if (parts.color_type & kPalette) {
        channels_ = clear.empty() ? 3 : 4;
        palette_.assign(256, {0, 0, 0, 1});  // indices beyond the palette are black
        for (std::size_t i = 0; i < parts.palette.size() / 3; ++i)
            for (std::size_t c = 0; c < 3; ++c)
                palette_[i][c] = static_cast<float>(parts.palette[3 * i + c]) / 255.0f;
        for (std::size_t i = 0; i < std::min<std::size_t>(clear.size(), palette_.size()); ++i)
            palette_[i][3] = static_cast<float>(clear[i]) / 255.0f;
        return;
    }
    const int color = parts.color_type & kColor ? 3 : 1;
    stored_ = channels_ = parts.color_type & kAlpha ? color + 1 : color;
    if (parts.color_type & kAlpha || clear.size() < 2 * static_cast<std::size_t>(color)) return;
    const ByteReader in(clear, ByteOrder::kBig);
    const std::uint32_t mask = (1u << parts.depth) - 1;  // only so many bits count
    auto& key = clear_.emplace();
    for (std::size_t c = 0; c < static_cast<std::size_t>(color); ++c) key[c] = in.number_at(2 * c, 2) & mask;
    ++channels_;
}

std::size_t PngRows::bytes(int width) const {
    return (static_cast<std::size_t>(width) * static_cast<std::size_t>(stored_ * parts_.depth) + 7) / 8;
}

bool PngRows::undo_filters(std::uint8_t* rows, int width, int height) const {
    const std::size_t size = bytes(width),
                      step = static_cast<std::size_t>(std::max(stored_ * parts_.depth / 8, 1));
    const std::vector<std::uint8_t> zeros(size);
    const std::uint8_t* up = zeros.data();
    for (int y = 0; y < height; ++y, rows += size + 1) {
        if (!undo_filter(rows[0], rows + 1, up, size, step)) return false;
        up = rows + 1;
    }
    return true;
}

std::uint32_t PngRows::code(const std::uint8_t* row, std::size_t sample) const {
    if (parts_.depth == 8) return row[sample];
    if (parts_.depth == 16) return static_cast<std::uint32_t>(row[2 * sample] << 8 | row[2 * sample + 1]);
    const auto depth = static_cast<std::size_t>(parts_.depth), bit = sample * depth;
    return static_cast<std::uint32_t>(row[bit / 8] >> (8 - depth - bit % 8)) & ((1u << depth) - 1);
}

void PngRows::expand(const std::uint8_t* row, int width, float* out) const {
    const auto pixels = static_cast<std::size_t>(width), stored = static_cast<std::size_t>(stored_);
    if (!palette_.empty()) {
        for (std::size_t x = 0; x < pixels; ++x)
            out = std::copy_n(palette_[code(row, x)].data(), channels_, out);
        return;
    }
    const auto most = static_cast<float>((1u << parts_.depth) - 1);
    if (parts_.depth == 8 && !clear_) {
        for (std::size_t i = 0; i < pixels * stored; ++i) out[i] = static_cast<float>(row[i]) / 255.0f;
        return;
    }
    for (std::size_t x = 0; x < pixels; ++x) {
        bool clear = clear_.has_value();
        for (std::size_t c = 0; c < stored; ++c) {
            const std::uint32_t value = code(row, x * stored + c);
            *out++ = static_cast<float>(value) / most;
            clear = clear && value == (*clear_)[c];
        }
        if (clear_) *out++ = clear ? 0.0f : 1.0f;
    }
}

}  // namespace imgmesh
