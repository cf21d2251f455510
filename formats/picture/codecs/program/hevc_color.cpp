#include "formats/picture/codecs/program/hevc_color.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <vector>

#include "formats/files/byte_reader.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

// Bits of a parameter set, the most significant first; zeros after its end.
class Bits {
  public:
    // Drops the bytes that keep start codes out of a stream.
    explicit Bits(Bytes stream) {
        int zeros = 0;
        for (const std::uint8_t byte : stream) {
            if (zeros >= 2 && byte == 3) {
                zeros = 0;
                continue;
            }
            zeros = byte == 0 ? zeros + 1 : 0;
            bytes_.push_back(byte);
        }
    }
    bool ended() const { return at_ > 8 * bytes_.size(); }
    void skip(std::size_t count) { at_ += count; }
    std::uint32_t number(int count) {
        std::uint32_t value = 0;
        for (int i = 0; i < count; ++i, ++at_)
            value = value << 1 | (at_ / 8 < bytes_.size() ? bytes_[at_ / 8] >> (7 - at_ % 8) & 1u : 0u);
        return value;
    }
    bool flag() { return number(1) == 1; }
    // Exp-Golomb (9.2); signed numbers have as many bits.
    std::uint32_t code() {
        int zeros = 0;
        while (zeros < 32 && !ended() && !flag()) ++zeros;
        return zeros < 32 ? (1u << zeros) - 1 + number(zeros) : ~0u;
    }
    void codes(int count) {
        for (int i = 0; i < count; ++i) code();
    }

  private:
    std::vector<std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

void skip_profile(Bits& in, int layers) {
    in.skip(96);
    std::array<std::array<bool, 2>, 8> present = {};
    for (int i = 0; i < layers; ++i) present[static_cast<std::size_t>(i)] = {in.flag(), in.flag()};
    if (layers > 0) in.skip(2 * static_cast<std::size_t>(8 - layers));
    for (int i = 0; i < layers; ++i) {
        if (present[static_cast<std::size_t>(i)][0]) in.skip(88);
        if (present[static_cast<std::size_t>(i)][1]) in.skip(8);
    }
}

void skip_scaling_lists(Bits& in) {
    for (int size = 0; size < 4; ++size)
        for (int matrix = 0; matrix < 6; matrix += size == 3 ? 3 : 1) {
            if (!in.flag())
                in.code();
            else
                in.codes(std::min(64, 1 << (4 + 2 * size)) + (size > 1 ? 1 : 0));
        }
}

// Returns false for more sets than there may be.
bool skip_reference_sets(Bits& in) {
    constexpr std::uint32_t kMost = 64;
    const std::uint32_t sets = in.code();
    if (sets > kMost) return false;
    std::uint32_t before = 0;
    for (std::uint32_t i = 0; i < sets; ++i) {
        if (i > 0 && in.flag()) {
            in.skip(1);
            in.code();
            std::uint32_t kept = 0;
            for (std::uint32_t j = 0; j <= before; ++j) kept += in.flag() || in.flag();
            before = kept;
        } else {
            const std::uint32_t negative = in.code(), positive = in.code();
            if (negative > kMost || positive > kMost) return false;
            before = negative + positive;
            for (std::uint32_t j = 0; j < before; ++j) {
                in.code();
                in.skip(1);
            }
        }
    }
    return true;
}

// Reads a sequence parameter set up to the description of colours.
std::optional<CodePoints> code_points_of(Bytes unit) {
    Bits in(unit);
    in.skip(16 + 4);
    const auto layers = static_cast<int>(in.number(3));
    in.skip(1);
    skip_profile(in, layers);
    in.code();
    const std::uint32_t chroma = in.code();
    if (chroma == 0) return std::nullopt;  // alpha or depth
    if (chroma == 3) in.skip(1);
    in.codes(2);
    if (in.flag()) in.codes(4);
    in.codes(2);
    const std::uint32_t order_bits = in.code() + 4;
    in.codes(3 * (in.flag() ? layers + 1 : 1));
    in.codes(6);
    if (in.flag() && in.flag()) skip_scaling_lists(in);
    in.skip(2);
    if (in.flag()) {
        in.skip(8);
        in.codes(2);
        in.skip(1);
    }
    if (!skip_reference_sets(in)) return std::nullopt;
    if (in.flag()) {
        const std::uint32_t long_term = in.code();
        if (long_term > 32 || order_bits > 16) return std::nullopt;
        in.skip(std::size_t{long_term} * (order_bits + 1));
    }
    in.skip(2);
    if (!in.flag()) return std::nullopt;  // nothing about use
    constexpr std::uint32_t kOwnRatio = 255;
    if (in.flag() && in.number(8) == kOwnRatio) in.skip(32);
    if (in.flag()) in.skip(1);
    if (!in.flag()) return std::nullopt;
    in.skip(4);
    if (!in.flag()) return std::nullopt;
    CodePoints codes;
    codes.primaries = static_cast<int>(in.number(8));
    codes.transfer = static_cast<int>(in.number(8));
    return in.ended() ? std::nullopt : std::optional(codes);
}

}  // namespace

std::optional<CodePoints> hevc_code_points(Bytes file) {
    constexpr std::size_t kWindow = std::size_t{1} << 20;  // a file's boxes are at its start
    const Bytes start = file.first(std::min(file.size(), kWindow));
    const std::string_view text = text_of(start);
    const ByteReader in(start, ByteOrder::kBig);
    for (std::size_t box = text.find("hvcC"); box != std::string_view::npos;
         box = text.find("hvcC", box + 4)) {
        std::size_t at = box + 4 + 22;
        const std::uint32_t arrays = in.number_at(at++, 1);
        for (std::uint32_t i = 0; i < arrays && at < start.size(); ++i) {
            constexpr std::uint32_t kSequence = 33;
            const std::uint32_t type = in.number_at(at, 1) & 63, units = in.number_at(at + 1, 2);
            at += 3;
            for (std::uint32_t j = 0; j < units && at + 2 < start.size(); ++j) {
                const std::size_t size = std::min<std::size_t>(in.number_at(at, 2), start.size() - at - 2);
                if (type == kSequence)
                    if (const auto codes = code_points_of(start.subspan(at + 2, size))) return codes;
                at += 2 + size;
            }
        }
    }
    return std::nullopt;
}

}  // namespace imgmesh
