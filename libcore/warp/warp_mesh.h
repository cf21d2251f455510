// The warped image as meshes.
#pragma once

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/solve_edits.h"

namespace imgmesh {

/// `mesh_image` with its vertices moved, rounded to kPositionStep; the pixel maps stay as they are, so the
/// image that they stand for is still the unwarped one, while the meshes are the warped one's.
///
/// A vertex moves as its level's edits have it, plus as the meshes of the other levels move at its place,
/// where their vertices move. `parameters` get "warp": true.
///
/// Throws Error(kUnsupported) where a face would turn over or lose its area, or a vertex would leave what a
/// container can hold: 131072 pixels from the origin.
MeshImage warp_mesh_image(MeshImage mesh_image, const std::vector<VertexMoves>& moves);

}  // namespace imgmesh
