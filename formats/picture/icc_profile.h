// ICC profiles, as far as they name one of our colour spaces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// The colour space whose primaries and curve an RGB matrix profile has (any ICC version); nothing for other
/// profiles and for bytes that are none. Source: ICC.1:2010 (4.3), sections 7 to 10.
std::optional<ColorSpace> color_space_from_icc(std::span<const std::uint8_t> profile);

/// A version 4 matrix profile of `space`; color_space_from_icc gives `space` back.
std::vector<std::uint8_t> icc_from_color_space(ColorSpace space);

}  // namespace imgmesh
