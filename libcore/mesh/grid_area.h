// Areas of triangles of pixels, wherever a map has moved these.
#pragma once

#include "libcore/base/types.h"

namespace imgmesh {

/// Twice the area of the triangle (a, b, c), positive where it runs clockwise on screen (x right, y down).
inline double grid_area2(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

}  // namespace imgmesh
