// Where points lie in a level's mesh by their place, not by its pixel map.
#pragma once

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns the trivial map of the level's mesh (trivial_map.h), of the size of its pixel map. Throws
/// Error(kUnsupported) for faces that lie over one another (check_cover()).
PixelMap cover_of(const Level& level);

/// Returns the face of the covered pixel nearest to a point, and the point's coordinates in it; they are
/// outside 0 to 1 for a point beside the face. The face is kNone if `cover` has none.
PixelCoord coord_near(const BaseMesh& mesh, const PixelMap& cover, const Vec2f& at);

/// Returns cover_of(), completed: a pixel that only the pixel map has a face for gets coord_near() it.
PixelMap map_by_place(const Level& level);

}  // namespace imgmesh
