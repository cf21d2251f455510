// One border between two regions, with fewer points and without stairs. Private to this folder.
#pragma once

#include <vector>

#include "libcore/segment/region_outlines.h"

namespace imgmesh {

/// Returns the line along corners of pixels, each one step from the one before; the last is the first again
/// if it is closed. The result starts and ends in the same points, except that a closed one may start
/// elsewhere. See region_outlines().
OutlineArc smooth_line(const std::vector<Vec2d>& corners, bool closed, double tolerance);

}  // namespace imgmesh
