// ICC profiles of our colour spaces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// Returns the colour space of an RGB matrix profile or a grey profile (any ICC version), as color_space_of()
/// does. Returns nothing for other profiles and for bytes that are no profile. Safe for any bytes.
std::optional<ColorSpace> color_space_from_icc(std::span<const std::uint8_t> profile);

/// Returns a version 4 matrix profile of `space`, always the same bytes; color_space_from_icc() recognises
/// it.
std::vector<std::uint8_t> icc_from_color_space(ColorSpace space);

}  // namespace imgmesh
