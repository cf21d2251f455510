// PNG by its specification (third edition), with libdeflate. Only missing pixels are an error; a PNG of iOS
// is read too.
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <new>

#include "formats/files/byte_reader.h"
#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/decode/png_chunks.h"
#include "formats/picture/decode/png_rows.h"
#include "libcore/base/error.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

using Bytes = std::span<const std::uint8_t>;

// One of the seven images of an interlaced PNG, or the whole one (section 8).
struct Pass {
    int x, y, step_x, step_y;
    int width, height;  ///< of this pass
};

std::vector<Pass> passes_of(const PngParts& parts) {
    const auto width = static_cast<int>(parts.width), height = static_cast<int>(parts.height);
    if (!parts.interlaced) return {{0, 0, 1, 1, width, height}};
    constexpr int kAdam7[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                  {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
    std::vector<Pass> passes;
    for (const auto& [x, y, step_x, step_y] : kAdam7)
        if (width > x && height > y)
            passes.push_back({x, y, step_x, step_y, (width - x + step_x - 1) / step_x,
                              (height - y + step_y - 1) / step_y});
    return passes;
}

// Unpacks to exactly `size` bytes.
std::vector<std::uint8_t> unpack(const std::string& path, PngParts& parts, std::size_t size) {
    const auto broken = [&](const std::string& what) {
        return Error(ErrorKind::kBadFile, cat(path, ": the PNG is ", what));
    };
    std::vector<std::uint8_t> joined;
    Bytes packed = parts.pixels.front();
    if (parts.pixels.size() > 1) {
        for (const Bytes piece : parts.pixels) joined.insert(joined.end(), piece.begin(), piece.end());
        packed = joined;
    }
    constexpr int kDeflate = 8, kDictionary = 32;
    if (packed.size() < 2 || (packed[0] & 15) != kDeflate || (packed[1] & kDictionary))
        throw broken("broken: its pixels are packed in an unknown way");
    packed = packed.subspan(2);
    // Deflate cannot pack more than 1032 bytes into one: no memory is taken for what cannot be there.
    if (size / 1032 > packed.size())
        throw broken(cat("truncated: ", packed.size(), " bytes cannot hold its pixels"));
    const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> unpacker(
        libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
    if (!unpacker) throw std::bad_alloc();
    constexpr std::size_t kRest =
        1 << 16;  // no piece of a stream is longer, so all before one that is too much fits
    std::vector<std::uint8_t> raw(size + kRest);
    std::size_t used = 0, made = 0;
    const libdeflate_result result = libdeflate_deflate_decompress_ex(
        unpacker.get(), packed.data(), packed.size(), raw.data(), raw.size(), &used, &made);
    if (result == LIBDEFLATE_BAD_DATA)
        throw broken(parts.complete ? "broken: its pixels do not unpack"
                                    : "truncated or broken: its pixels do not unpack");
    const bool more = result == LIBDEFLATE_INSUFFICIENT_SPACE;
    if (!more && made < size)
        throw broken(cat("truncated: it has ", made, " bytes of pixels, expected ", size));
    const bool summed = !more && packed.size() - used >= 4;
    const bool sound = summed && ByteReader(packed, ByteOrder::kBig).number_at(used, 4) ==
                                     libdeflate_adler32(1, raw.data(), made);
    if (!sound && !parts.pixels_checked && parts.complete)
        throw broken("broken: the checksum of its pixels is wrong");
    if (summed && !sound)
        parts.warnings.push_back("the checksum of its unpacked pixels is wrong");
    else if (!parts.pixels_checked && parts.complete)
        parts.warnings.push_back(
            "the checksum of its packed pixels is wrong, that of the unpacked ones is right");
    if (more || made > size) parts.warnings.push_back("it holds more pixels than it says");
    raw.resize(size);
    return raw;
}

}  // namespace

DecodedPicture decode_png(const PictureFile& file) {
    PngParts parts = png_parts(file.path, file.bytes);
    const PngRows rows(parts);
    check_size(file.path, parts.width, parts.height, rows.channels(), file.options.limits);
    const std::vector<Pass> passes = passes_of(parts);
    std::size_t size = 0;
    for (const Pass& pass : passes)
        size += static_cast<std::size_t>(pass.height) * (1 + rows.bytes(pass.width));
    std::vector<std::uint8_t> raw = unpack(file.path, parts, size);

    DecodedPicture out;
    out.image = make_image(static_cast<int>(parts.width), static_cast<int>(parts.height), rows.channels());
    out.image.sample_type = parts.depth == 16 ? SampleType::kUint16 : SampleType::kUint8;
    std::uint8_t* at = raw.data();
    for (const Pass& pass : passes) {
        const std::size_t step = 1 + rows.bytes(pass.width);
        if (!rows.undo_filters(at, pass.width, pass.height))
            throw Error(ErrorKind::kBadFile,
                        cat(file.path, ": the PNG is broken: a row has an unknown filter"));
        constexpr int kGrainRows = 32;
        parallel_blocks(0, pass.height, kGrainRows, [&](int first, int last) {
            std::vector<float> samples(static_cast<std::size_t>(pass.width) *
                                       static_cast<std::size_t>(rows.channels()));
            for (int y = first; y < last; ++y) {
                const std::uint8_t* const row = at + static_cast<std::size_t>(y) * step + 1;
                float* const to = out.image.pixel(pass.x, pass.y + y * pass.step_y);
                if (pass.step_x == 1) {
                    rows.expand(row, pass.width, to);
                    continue;
                }
                rows.expand(row, pass.width, samples.data());
                for (int x = 0; x < pass.width; ++x)
                    std::copy_n(samples.data() + static_cast<std::ptrdiff_t>(x) * rows.channels(),
                                rows.channels(),
                                to + static_cast<std::ptrdiff_t>(x) * pass.step_x * rows.channels());
            }
        });
        at += static_cast<std::size_t>(pass.height) * step;
    }
    if (!parts.complete) parts.warnings.push_back("the PNG ends early, but all of its pixels are there");
    out.orientation = parts.orientation;
    out.color = std::move(parts.color);
    out.warnings = std::move(parts.warnings);
    return out;
}

}  // namespace imgmesh
