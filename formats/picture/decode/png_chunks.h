// The chunks of a PNG file: what its pixels need, and what else imgmesh obeys.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/color/stated_color.h"

namespace imgmesh {

struct PngParts {
    std::uint32_t width = 0, height = 0;
    int depth = 0;       ///< bits a sample
    int color_type = 0;  ///< of section 11.2.1: 1 palette, 2 colour, 4 alpha, as bits
    bool interlaced = false;
    std::span<const std::uint8_t> palette;
    std::span<const std::uint8_t> transparency;         ///< the content of tRNS
    std::vector<std::span<const std::uint8_t>> pixels;  ///< of the IDAT chunks
    bool pixels_checked = true;                         ///< their checksums are right
    bool complete = true;                               ///< the file ends with IEND
    StatedColor color;
    int orientation = 0;  ///< 1 to 8; 0 if it is not said
    std::vector<std::string> warnings;
};

/// Finds the chunks up to IEND or the end of the file. Chunks that are not used are not looked at, whatever
/// they hold. Of those that say how colours are meant and how the image stands, a broken one becomes a
/// warning. Throws Error: kBadFile for a broken header, palette or transparency and for no pixels;
/// kUnsupported for critical chunks that PNG does not have.
PngParts png_parts(const std::string& path, std::span<const std::uint8_t> bytes);

}  // namespace imgmesh
