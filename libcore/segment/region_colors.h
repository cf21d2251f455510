// A colour of its own for each region, to tell regions apart.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

/// Red, green and blue codes of 8 bits, sRGB.
using RgbCode = std::array<std::uint8_t, 3>;

/// Returns a colour for each region: no two regions have the same, unless there are nearly as many as there
/// are colours of 8 bits, none is near black, and neighbours differ clearly. Colours depend on the regions'
/// numbers and neighbours alone. Takes O(regions + neighbours) time.
std::vector<RgbCode> distinct_colors(const std::vector<RegionFacts>& facts);

/// Draws each region in its colour: RGB of 8 bits, with A, which is 0 there, if some pixel is outside a mask.
Image draw_colors(const LabelImage& labels, const std::vector<RgbCode>& colors);

}  // namespace imgmesh
