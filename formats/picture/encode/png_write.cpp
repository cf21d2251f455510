// PNG files (ISO/IEC 15948): rows filtered on all threads, then one stream of libdeflate, which packs them as
// well as zlib in less than a third of the time (docs/decisions/0016-fast-files.md).
#include <libdeflate.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <string_view>

#include "formats/files/byte_writer.h"
#include "formats/picture/color/icc_profile.h"
#include "formats/picture/encode/picture_encoders.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

constexpr int kFilters = 5;
constexpr int kGrainRows = 16;
constexpr int kLevel = 6;  // of libdeflate: faster ones grow the file, slower ones hardly shrink it
// Some readers take no longer chunk in one piece; all must take several.
constexpr std::size_t kMaxChunk = std::size_t{1} << 30;

void put_chunk(Bytes& out, std::string_view name, View content) {
    append_number(out, content.size(), 4, ByteOrder::kBig);
    const std::size_t start = out.size();
    out.insert(out.end(), name.begin(), name.end());
    out.insert(out.end(), content.begin(), content.end());
    append_number(out, libdeflate_crc32(0, out.data() + start, out.size() - start), 4, ByteOrder::kBig);
}

Bytes packed(View bytes) {
    const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
        libdeflate_alloc_compressor(kLevel), libdeflate_free_compressor);
    if (!compressor) throw std::bad_alloc();
    Bytes out(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()));
    out.resize(
        libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), out.data(), out.size()));
    return out;
}

std::uint8_t paeth(int left, int up, int corner) {
    const int to_left = std::abs(up - corner), to_up = std::abs(left - corner),
              to_corner = std::abs(left + up - 2 * corner);
    const int nearer = to_up <= to_corner ? up : corner;
    return static_cast<std::uint8_t>(to_left <= to_up && to_left <= to_corner ? left : nearer);
}

// Applies filter `kind` (section 9.2) to one row and writes the filter's number before it: `size` bytes,
// `step` bytes a pixel, `up` the row above or zeros. `row` and `up` have `step` zeros before their first
// byte.
void filter_row(int kind, const std::uint8_t* row, const std::uint8_t* up, std::size_t size, std::size_t step,
                std::uint8_t* out) {
    const std::uint8_t *left = row - step, *corner = up - step;
    *out++ = static_cast<std::uint8_t>(kind);
    switch (kind) {
        case 0:
            std::memcpy(out, row, size);
            break;
        case 1:
            for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(row[i] - left[i]);
            break;
        case 2:
            for (std::size_t i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(row[i] - up[i]);
            break;
        case 3:
            for (std::size_t i = 0; i < size; ++i)
                out[i] = static_cast<std::uint8_t>(row[i] - (left[i] + up[i]) / 2);
            break;
        default:
            for (std::size_t i = 0; i < size; ++i)
                out[i] = static_cast<std::uint8_t>(row[i] - paeth(left[i], up[i], corner[i]));
    }
}

// Returns the sum of the bytes as distances from zero: the specification's measure (section 12.7) of how well
// they compress.
std::uint64_t weight(const std::uint8_t* bytes, std::size_t size) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < size; ++i)
        sum += static_cast<std::uint64_t>(std::abs(static_cast<std::int8_t>(bytes[i])));
    return sum;
}

// Filters all rows, each with the filter of the smallest such sum, the first of equal ones. `row_of(y, out)`
// fills in row y.
template <typename RowOf>
Bytes filtered(int height, std::size_t size, std::size_t step, const RowOf& row_of) {
    Bytes out(static_cast<std::size_t>(height) * (size + 1));
    parallel_blocks(0, height, kGrainRows, [&](int first, int last) {
        Bytes row(step + size), up(step + size);
        std::array<Bytes, kFilters> tries;
        for (Bytes& t : tries) t.resize(size + 1);
        if (first > 0) row_of(first - 1, up.data() + step);
        for (int y = first; y < last; ++y) {
            row_of(y, row.data() + step);
            int best = 0;
            auto least = std::numeric_limits<std::uint64_t>::max();
            for (int kind = 0; kind < kFilters; ++kind) {
                Bytes& t = tries[static_cast<std::size_t>(kind)];
                filter_row(kind, row.data() + step, up.data() + step, size, step, t.data());
                const std::uint64_t w = weight(t.data() + 1, size);
                if (w < least) {
                    least = w;
                    best = kind;
                }
            }
            std::memcpy(out.data() + static_cast<std::size_t>(y) * (size + 1),
                        tries[static_cast<std::size_t>(best)].data(), size + 1);
            row.swap(up);
        }
    });
    return out;
}

Bytes filtered_picture(const Image& image, bool wide) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const std::size_t samples = static_cast<std::size_t>(image.width) * channels;
    if (!wide) {
        const std::vector<std::uint8_t> codes = codes8_from_floats(image.data);
        return filtered(image.height, samples, channels, [&](int y, std::uint8_t* out) {
            std::memcpy(out, codes.data() + static_cast<std::size_t>(y) * samples, samples);
        });
    }
    const std::vector<std::uint16_t> codes = codes16_from_floats(image.data);
    return filtered(image.height, 2 * samples, 2 * channels, [&](int y, std::uint8_t* out) {
        const std::uint16_t* row = codes.data() + static_cast<std::size_t>(y) * samples;
        for (std::size_t i = 0; i < samples; ++i) {
            out[2 * i] = static_cast<std::uint8_t>(row[i] >> 8);
            out[2 * i + 1] = static_cast<std::uint8_t>(row[i]);
        }
    });
}

}  // namespace

Bytes encode_png(const Image& image, SampleType type) {
    constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    constexpr std::uint8_t kColorTypes[] = {0, 4, 2, 6};  // by channels, from 1
    const bool wide = type == SampleType::kUint16;
    Bytes out(std::begin(kSignature), std::end(kSignature)), header;
    append_number(header, static_cast<std::uint32_t>(image.width), 4, ByteOrder::kBig);
    append_number(header, static_cast<std::uint32_t>(image.height), 4, ByteOrder::kBig);
    // Bits; then neither another compression nor filters nor interlacing.
    for (const std::uint8_t byte : {std::uint8_t(wide ? 16 : 8), kColorTypes[image.channels - 1],
                                    std::uint8_t{0}, std::uint8_t{0}, std::uint8_t{0}})
        header.push_back(byte);
    put_chunk(out, "IHDR", header);
    if (image.color_space == ColorSpace::kSrgb) {
        put_chunk(out, "sRGB", std::array<std::uint8_t, 1>{0});  // perceptual
        put_chunk(out, "gAMA",
                  std::array<std::uint8_t, 4>{0, 0, 0xB1, 0x8F});  // 45455, for those who know no sRGB
    } else {
        Bytes profile = {'I', 'C', 'C', 0, 0};
        const Bytes content = packed(icc_from_color_space(image.color_space));
        profile.insert(profile.end(), content.begin(), content.end());
        put_chunk(out, "iCCP", profile);
    }
    const Bytes pixels = packed(filtered_picture(image, wide));
    out.reserve(out.size() + pixels.size() + 64);
    for (std::size_t at = 0; at < pixels.size(); at += kMaxChunk)
        put_chunk(out, "IDAT", View(pixels).subspan(at, std::min(kMaxChunk, pixels.size() - at)));
    put_chunk(out, "IEND", {});
    return out;
}

}  // namespace imgmesh
