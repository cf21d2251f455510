// Where SVG drawings have the vertices of a mesh.
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns the vertices of a level's mesh. Those on the image's sides move out by half a pixel, to the outer
/// edge of the outermost pixels, and those on the boundary of a masked image as outer_positions() has them.
std::vector<Vec2d> outward(const Level& level, const SourceInfo& source);

}  // namespace imgmesh
