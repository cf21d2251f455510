// Files of TIFF by libtiff, with samples of any depth packed by the tests themselves.
#pragma once

#include <doctest/doctest.h>
#include <tiffio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "libcore/base/error.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// How the samples lie in a file. Blocks are tiles of 16 x 16, or strips.
struct TiffShape {
    int width = 37, height = 21, samples = 1, bits = 8;
    int photometric = PHOTOMETRIC_MINISBLACK;
    int format = SAMPLEFORMAT_UINT;
    bool planar = false, tiled = false;
    int compression = COMPRESSION_NONE;
    int rows = 5;            ///< of a strip
    const char* mode = "w";  ///< of TIFFOpen(): "wb" for the other byte order, "w8" for BigTIFF
    std::vector<std::uint16_t> extras = {};
};

/// Appends codes to bytes as TIFF wants them: whole bytes in the machine's order, other depths as bits, the
/// most significant first, each row padded to a byte.
inline std::vector<std::uint8_t> packed_row(const std::vector<std::uint64_t>& codes, int bits) {
    std::vector<std::uint8_t> row;
    if (bits % 8 == 0) {
        for (const std::uint64_t code : codes)
            for (int i = 0; i < bits; i += 8) row.push_back(static_cast<std::uint8_t>(code >> i));
        return row;
    }
    row.resize((codes.size() * static_cast<std::size_t>(bits) + 7) / 8);
    std::size_t at = 0;
    for (const std::uint64_t code : codes)
        for (int i = bits - 1; i >= 0; --i, ++at)
            if (((code >> i) & 1) != 0)
                row[at / 8] = static_cast<std::uint8_t>(row[at / 8] | 0x80u >> at % 8);
    return row;
}

/// Writes the current page of `tiff`: code(x, y, sample) gives the bits of each sample. `change` sets further
/// tags before the pixels.
inline void write_tiff_page(TIFF* tiff, const TiffShape& shape,
                            const std::function<std::uint64_t(int, int, int)>& code,
                            const std::function<void(TIFF*)>& change = {}) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, shape.width);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, shape.height);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, shape.samples);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, shape.bits);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, shape.photometric);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, shape.format);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, shape.compression);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, shape.planar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    if (!shape.extras.empty())
        TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, static_cast<int>(shape.extras.size()), shape.extras.data());
    const int wide = shape.tiled ? 16 : shape.width, high = shape.tiled ? 16 : shape.rows;
    if (shape.tiled) {
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, wide);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, high);
    } else {
        TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, high);
    }
    if (change) change(tiff);
    std::uint32_t index = 0;
    for (int plane = 0; plane < (shape.planar ? shape.samples : 1); ++plane)
        for (int top = 0; top < shape.height; top += high)
            for (int left = 0; left < shape.width; left += wide) {
                std::vector<std::uint8_t> block;
                for (int y = top; y < top + high && (shape.tiled || y < shape.height); ++y) {
                    std::vector<std::uint64_t> codes;
                    for (int x = left; x < left + wide; ++x)
                        for (int s = plane; s < (shape.planar ? plane + 1 : shape.samples); ++s)
                            codes.push_back(x < shape.width && y < shape.height ? code(x, y, s) : 0);
                    const auto row = packed_row(codes, shape.bits);
                    block.insert(block.end(), row.begin(), row.end());
                }
                const auto size = static_cast<tmsize_t>(block.size());
                REQUIRE((shape.tiled ? TIFFWriteEncodedTile(tiff, index, block.data(), size)
                                     : TIFFWriteEncodedStrip(tiff, index, block.data(), size)) == size);
                ++index;
            }
    REQUIRE(TIFFWriteDirectory(tiff) == 1);
}

// Any codes: a hash of the place.
inline std::uint64_t noise(int x, int y, int sample, int bits) {
    std::uint64_t h = static_cast<std::uint64_t>(x * 7919 + y * 104729 + sample * 1299709) + 1;
    h *= 0x9E3779B97F4A7C15u;
    h ^= h >> 29;
    return bits == 64 ? h : h & ((std::uint64_t{1} << bits) - 1);
}

inline std::string label(const TiffShape& s) {
    return cat(s.bits, " bits, ", s.samples, " samples", s.planar ? ", planar" : "", s.tiled ? ", tiled" : "",
               ", mode ", s.mode, ", photometric ", s.photometric, ", compression ", s.compression);
}

inline void check_samples(const Image& image, const std::function<double(int, int, int)>& expected,
                          double tolerance = 1e-7) {
    double worst = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x)
            for (int c = 0; c < image.channels; ++c)
                worst =
                    std::max(worst, std::abs(static_cast<double>(image.pixel(x, y)[c]) - expected(x, y, c)));
    CHECK(worst <= tolerance);
}

using TiffHandle = std::unique_ptr<TIFF, void (*)(TIFF*)>;

inline TiffHandle create_tiff(const std::string& path, const char* mode = "w") {
    TIFFSetWarningHandler(nullptr);
    TiffHandle tiff(TIFFOpen(path.c_str(), mode), TIFFClose);
    REQUIRE(tiff);
    return tiff;
}

inline void write_tiff(const std::string& path, const TiffShape& shape,
                       const std::function<std::uint64_t(int, int, int)>& code,
                       const std::function<void(TIFF*)>& change = {}) {
    write_tiff_page(create_tiff(path, shape.mode).get(), shape, code, change);
}

}  // namespace imgmesh
