// Another shape for an image, at the expense of where there is little to see.
#pragma once

#include "libcore/mesh/base_mesh.h"
#include "libcore/warp/displacement.h"
#include "libcore/warp/warp_image.h"

namespace imgmesh {

/// Moves of the vertices of a mesh over a whole width x height image, for a drawing of `size`, so that
/// small faces, which the collapse leaves where there is detail, keep their shape, and large ones take the
/// change of proportions. Sides stay sides; no face turns over.
///
/// Minimises sum over faces of w |grad (X, Y) - s I|^2 A for places (X, Y) in the drawing, w falling with the
/// face's area and s the face's own best scale, found by turns (as in Wang et al. 2008, "Optimized
/// scale-and-stretch"; linear systems over the mesh, factorised once).
///
/// Throws Error(kBadArgument) for a size outside what warp_image() draws.
VertexMoves retarget_moves(const BaseMesh& mesh, int width, int height, const OutputSize& size);

/// The field that draws level 0 so. Pixels move with the face that covers them, not through the pixel map,
/// which follows edges too closely for moves as large as these. Throws as retarget_moves(),
/// Error(kUnsupported) for a masked image, which has no sides.
DisplacementField retarget_field(const MeshImage& mesh_image, const OutputSize& size);

/// The sum of two fields of one image.
void add_field(DisplacementField& sum, const DisplacementField& field);

}  // namespace imgmesh
