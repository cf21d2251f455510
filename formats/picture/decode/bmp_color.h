// The colour space in a BMP's header of version 4 or 5.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/color/stated_color.h"

namespace imgmesh {

/// Fills in what the header, which `bytes` begin with, says about colours. Warns of a profile that is in
/// another file or not in this one. Source: BITMAPV5HEADER, LogicalColorSpace.
void state_bmp_color(std::span<const std::uint8_t> bytes, StatedColor& color,
                     std::vector<std::string>& warnings);

}  // namespace imgmesh
