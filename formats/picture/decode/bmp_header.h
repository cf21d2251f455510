// What a BMP file says before its pixels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/color/stated_color.h"
#include "formats/picture/decode/palette_image.h"

namespace imgmesh {

enum class BmpCoding { kRows, kRuns4, kRuns8, kFile };

struct BmpHeader {
    std::int64_t width = 0, height = 0;
    bool top_down = false;
    int bits = 0;                         ///< a pixel: 1, 2, 4, 8 (indices), 16, 24 or 32
    BmpCoding coding = BmpCoding::kRows;  ///< kFile: the pixels are a PNG or JPEG file
    std::array<std::uint32_t, 4> masks =
        {};                             ///< of R, G, B and A in a pixel; 0 for a channel that is not stored
    std::vector<PaletteColor> palette;  ///< of indices; may be shorter than their range
    std::size_t pixels = 0;             ///< where they begin in the file
    StatedColor color;
    std::vector<std::string> warnings;
};

/// Reads the headers of Windows (12, 40, 52, 56, 108 and 124 bytes) and OS/2 (12 and 16 to 64 bytes), alone
/// or first in a bitmap array. Sizes are as stated, not checked. Throws Error: kBadFile for what contradicts
/// itself, kUnsupported for OS/2's Huffman code and runs of 24 bits, 64 bits, and compressions of printers.
BmpHeader read_bmp_header(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace imgmesh
