// The warped picture as meshes.
#pragma once

#include "libcore/param/mesh_image.h"
#include "libcore/warp/solve_edits.h"

namespace imgmesh {

/// `mesh_image` with its vertices moved, rounded to kPositionStep; the pixel maps stay as they are, so the
/// picture that they stand for is still the unwarped one, while the meshes are the warped one's.
///
/// A vertex moves as its level's edits have it, plus what edits of the other levels do to the pixel that lies
/// nearest to it in the level's own map. `parameters` get "warp": true.
///
/// Throws Error(kUnsupported) where a face would turn over or lose its area, or a vertex would leave what a
/// container can hold: 131072 pixels from the origin.
MeshImage warp_mesh_image(MeshImage mesh_image, const std::vector<VertexMoves>& moves);

}  // namespace imgmesh
