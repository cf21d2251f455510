// ICC profiles, as far as they name one of our colour spaces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// The colour space in which an RGB matrix profile (any ICC version) does the same to colours, up to what
/// profiles differ by; nothing for other profiles and for bytes that are none. Of a profile that has tables
/// as well, the matrix counts. Safe for any bytes.
std::optional<ColorSpace> color_space_from_icc(std::span<const std::uint8_t> profile);

/// A version 4 matrix profile of `space`, the same bytes each time; color_space_from_icc gives `space` back.
std::vector<std::uint8_t> icc_from_color_space(ColorSpace space);

}  // namespace imgmesh
