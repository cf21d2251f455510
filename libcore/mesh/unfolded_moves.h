// Moves of vertices under which a pixel map stays without folds.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Takes moves back until none turns over a face, or a triangle of three neighbouring pixels that lie on
/// their faces with the same weights as before. What is folded already stays as it is.
///
/// position  where each vertex of `mesh` is to move; those of moves that are taken back become the mesh's own
///
/// Takes O(pixels) time for each round; a round takes back at least one move, and a few rounds are usual.
void take_back_folds(const BaseMesh& mesh, const PixelMap& map, std::vector<Vec2f>& position);

}  // namespace imgmesh
