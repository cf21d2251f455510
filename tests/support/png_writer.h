// PNG files of every kind, by libpng.
#pragma once

#include <doctest/doctest.h>
#include <png.h>

#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

namespace imgmesh {

struct PngKind {
    int color_type, bits;
    bool interlaced, transparent;
};

/// Random samples of that kind by libpng, with a transparent colour (or half transparent palette) where
/// asked.
inline void write_png(const std::string& path, int width, int height, const PngKind& kind, unsigned seed) {
    std::mt19937 random(seed);
    std::FILE* file = std::fopen(path.c_str(), "wb");
    REQUIRE(file);
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), kind.bits,
                 kind.color_type, kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const bool palette = kind.color_type == PNG_COLOR_TYPE_PALETTE;
    const int colors = 1 << std::min(kind.bits, 8);
    if (palette) {
        std::vector<png_color> table;
        std::vector<png_byte> alpha;
        for (int i = 0; i < colors; ++i) {
            const auto byte = [&] { return static_cast<png_byte>(random()); };
            table.push_back({byte(), byte(), byte()});
            if (i < colors / 2) alpha.push_back(byte());
        }
        png_set_PLTE(png, info, table.data(), colors);
        if (kind.transparent) png_set_tRNS(png, info, alpha.data(), colors / 2, nullptr);
    } else if (kind.transparent) {
        const png_color_16 key = {0, 1, 1, 1, 1};
        png_set_tRNS(png, info, nullptr, 0, &key);
    }
    png_write_info(png, info);
    std::vector<png_byte> bytes(png_get_rowbytes(png, info) * static_cast<std::size_t>(height));
    std::vector<png_bytep> rows;
    // Small samples, so that the transparent colour occurs.
    for (png_byte& b : bytes) b = static_cast<png_byte>(kind.bits < 8 ? random() : random() % 3);
    for (int y = 0; y < height; ++y)
        rows.push_back(bytes.data() + png_get_rowbytes(png, info) * static_cast<std::size_t>(y));
    png_write_image(png, rows.data());
    png_write_end(png, info);
    png_destroy_write_struct(&png, &info);
    std::fclose(file);
}

}  // namespace imgmesh
