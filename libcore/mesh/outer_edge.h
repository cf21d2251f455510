// The boundary of a base mesh moved to the outer edge of its pixels, as engines and programs for meshes want
// it.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Returns positions for the vertices of `mesh` with which it covers the whole squares of its pixels, those
/// with a face in `map`. The mesh itself covers their centres, so half a pixel is missing all around: a
/// sprite of 40 x 32 pixels would be 39 x 31. Only vertices on the boundary move: outwards as little as that
/// takes, straight sides by exactly half a pixel, and back where a straight side of the mask bulges. A
/// rectangle of pixels becomes exactly that rectangle. All faces keep a positive area, and positions stay on
/// kPositionStep and in the image. Where a face would turn over (between single pixels), or the mask has a
/// tip on a side of the image, vertices move less, and parts of squares there are not covered.
///
/// Takes O(faces log faces + pixels at the boundary) time.
std::vector<Vec2f> outer_positions(const BaseMesh& mesh, const PixelMap& map);

/// Moves the vertices of all levels so that they cover whole pixels, and no map folds by that. The mesh of a
/// whole image is stretched to its sides. Of masked images, boundaries move to outer_positions(), and moves
/// that would fold the map are left out: there parts of squares are not covered. Maps keep their weights, so
/// that the reconstruction through them stays the same to the bit.
void extend_to_outer_edge(MeshImage& mesh_image);

/// Moves the vertices of all levels to outer_positions(), for meshes whose pixel maps are not kept: maps may
/// fold by that, and do not decide anything.
void cover_whole_pixels(MeshImage& mesh_image);

}  // namespace imgmesh
