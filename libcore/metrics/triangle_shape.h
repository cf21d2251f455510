// Measures of how good one triangle is. By all of them the equilateral triangle is best.
#pragma once

#include "libcore/base/types.h"

namespace imgmesh {

/// Measures of one triangle. Sources: Field, "Qualitative measures for initial meshes", 2000 (edge ratio,
/// radius ratio, shape); Shewchuk, "Delaunay refinement algorithms for triangular mesh generation", 2002
/// (radius-edge ratio).
struct TriangleShape {
    double edge_ratio = 0;         ///< longest edge / shortest edge; best 1, grows
    double aspect_ratio = 0;       ///< sqrt(3)/2 longest edge / shortest altitude; best 1, grows
    double radius_ratio = 0;       ///< 2 inradius / circumradius; best 1, falls to 0
    double radius_edge_ratio = 0;  ///< circumradius / shortest edge (paper sec. 3.4); best 1/sqrt(3), grows
    double shape = 0;              ///< q = 4 sqrt(3) area / sum of squared edges; best 1, falls to 0
    double min_angle_deg = 0;      ///< smallest angle [degrees]; best 60, falls to 0
};

/// Measures the triangle (a, b, c), whose signed_area2() must be positive.
TriangleShape triangle_shape(const Vec2f& a, const Vec2f& b, const Vec2f& c);

}  // namespace imgmesh
