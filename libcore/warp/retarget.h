// Changes an image's proportions at the expense of areas with little detail.
#pragma once

#include "libcore/mesh/base_mesh.h"
#include "libcore/warp/displacement.h"
#include "libcore/warp/warp_image.h"

namespace imgmesh {

/// Returns the moves of the vertices of a mesh over a whole width x height image, for a drawing of `size`.
/// Small faces, which the collapse leaves where there is detail, keep their shape; large ones take the change
/// of proportions. Sides stay sides, and no face turns over.
///
/// Minimises the sum over faces of w |grad (X, Y) - s I|^2 A for places (X, Y) in the drawing. The weight w
/// falls with the face's area. s is the face's own best scale, found alternately with the places as in Wang
/// et al. 2008, "Optimized scale-and-stretch". The linear systems are over the mesh and factorised once.
///
/// Throws Error(kBadArgument) for a size that warp_image() does not draw.
VertexMoves retarget_moves(const BaseMesh& mesh, int width, int height, const OutputSize& size);

/// Returns the field that draws level 0 with these moves, for warp_image(image, field, size). Pixels move
/// with the face that covers them, not through the pixel map, which follows edges too closely for moves this
/// large. Throws as retarget_moves() does, and Error(kUnsupported) for a masked image, which has no sides,
/// and for faces that lie over one another (check_cover()).
DisplacementField retarget_field(const MeshImage& mesh_image, const OutputSize& size);

/// Adds the moves of `field` to those of `sum`. Both are fields of one image.
void add_field(DisplacementField& sum, const DisplacementField& field);

}  // namespace imgmesh
