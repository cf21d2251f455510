// Where points lie in a level's mesh by their place, not by its pixel map.
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/solve_edits.h"

namespace imgmesh {

/// Returns the trivial map of a mesh (trivial_map.h), of the given size [pixels]. Throws Error(kUnsupported)
/// for faces that lie over one another (check_cover()).
PixelMap cover_of(const BaseMesh& mesh, const GridSize& size);

/// Returns the face of the covered pixel nearest to a point, and the point's coordinates in it; they are
/// outside 0 to 1 for a point beside the face. The face is kNone if `cover` has none.
PixelCoord coord_near(const BaseMesh& mesh, const PixelMap& cover, const Vec2f& at);

/// Returns the trivial map of a mesh, completed: a pixel without a face that has one in `map` gets
/// coord_near() it. Throws as cover_of() does.
PixelMap map_by_place(const BaseMesh& mesh, const PixelMap& map);

/// Adds to `sum` the moves that the mesh of `level` has at the places `at` [pixels]. They are linear over
/// each of its faces, in the face that covers the pixel nearest to the place. The pixel map is not used: it
/// follows edges of the image closely and so changes too fast for vertices. Fine faces would turn over where
/// coarse ones are merely stretched.
///
/// moves  of the level's vertices
/// sum    one for each place
///
/// Takes O(pixels) time. Throws as cover_of() does.
void add_moves_at(const Level& level, const VertexMoves& moves, const std::vector<Vec2f>& at,
                  std::vector<Vec2f>& sum);

}  // namespace imgmesh
