// The mesh of a whole image stretched to the sides of its outermost pixels.
#pragma once

#include <optional>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Returns positions with which a mesh that reaches to the centres of the outermost pixels reaches to their
/// outer sides: x from -1/2 to width - 1/2, y alike. All is stretched by width / (width - 1), since no linear
/// map folds what lies on it; vertices that the grid of kPositionStep would bring too near to each other are
/// put one step beside their place. So no face turns over, and no triangle of three neighbouring pixels.
/// Returns nothing where that is not possible, or where the mesh fills no rectangle between these two (one
/// that was warped).
///
/// Takes O(pixels) time.
std::optional<std::vector<Vec2f>> stretched_positions(const BaseMesh& mesh, const PixelMap& map);

}  // namespace imgmesh
