#include "libcore/metrics/triangle_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

TriangleShape triangle_shape(const Vec2f& a, const Vec2f& b, const Vec2f& c) {
    const double area2 = signed_area2(a, b, c);
    const Vec2d pa = a.cast<double>(), pb = b.cast<double>(), pc = c.cast<double>();
    double length[3] = {(pb - pc).norm(), (pc - pa).norm(), (pa - pb).norm()};
    std::sort(length, length + 3);
    const auto [shortest, middle, longest] = length;
    const double perimeter = shortest + middle + longest;
    const double circumradius = shortest * middle * longest / (2 * area2);

    TriangleShape s;
    s.edge_ratio = longest / shortest;
    // The shortest altitude stands on the longest edge: area2 / longest.
    s.aspect_ratio = std::sqrt(3.0) / 2 * longest * longest / area2;
    // inradius = area2 / perimeter
    s.radius_ratio = 4 * area2 * area2 / (perimeter * shortest * middle * longest);
    s.radius_edge_ratio = circumradius / shortest;
    s.shape = 2 * std::sqrt(3.0) * area2 / (shortest * shortest + middle * middle + longest * longest);
    // The least angle lies opposite the shortest side, between the two others.
    const double cosine2 = middle * middle + longest * longest - shortest * shortest;
    s.min_angle_deg = std::atan2(2 * area2, cosine2) * 180 / std::numbers::pi;
    return s;
}

}  // namespace imgmesh
