// Warps the meshes instead of the image.
#pragma once

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/solve_edits.h"

namespace imgmesh {

/// Returns `mesh_image` with its vertices moved and rounded to kPositionStep. The pixel maps stay, so through
/// them one still gets the unwarped image, while the meshes show the warped one.
///
/// A vertex moves by its own level's edits, and by what the meshes of the other levels do at its place.
/// `parameters` get "warp": true.
///
/// Throws Error(kUnsupported) if a face would turn over or lose its area, or if a vertex would leave what a
/// container can hold, 131072 pixels from the origin.
MeshImage warp_mesh_image(MeshImage mesh_image, const std::vector<VertexMoves>& moves);

}  // namespace imgmesh
