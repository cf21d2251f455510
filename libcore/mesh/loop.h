// Outlines as polygons.
#pragma once

#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// A closed polygon [pixels]: inside is on its left on screen, so outer outlines run counter-clockwise and
/// holes clockwise.
using Loop = std::vector<Vec2d>;

/// Where a simplified outline may lie.
enum class OutlineSide {
    kOut,  ///< never inside the mask: no pixel inside is cut
    kBoth  ///< on either side
};

}  // namespace imgmesh
