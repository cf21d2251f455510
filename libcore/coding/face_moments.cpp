#include "libcore/coding/face_moments.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/index.h"

namespace imgmesh::coding {
namespace {

struct Point {
    double x, y;
};

double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The corners in pixels; all numbers are multiples of 1/4, so that comparisons with zero are exact.
std::array<Point, 3> corners_of(const CodedShape& shape, const Face& face) {
    std::array<Point, 3> out;
    for (std::size_t i = 0; i < 3; ++i) {
        const GridPoint& p = shape.point[face[i]];
        out[i] = {shape.grid.x(p[0]) / 4.0, shape.grid.y(p[1]) / 4.0};
    }
    return out;
}

// Calls visit(pixel, weights) for pixels whose centres lie in the closed face.
template <class Visit>
void visit_pixels(const CodedShape& shape, const std::array<Point, 3>& p, Visit&& visit) {
    const double area = cross(p[0], p[1], p[2]);
    if (area == 0) return;
    const auto [left, right] = std::minmax({p[0].x, p[1].x, p[2].x});
    const auto [top, bottom] = std::minmax({p[0].y, p[1].y, p[2].y});
    const int last_x = std::min(static_cast<int>(right), shape.grid.width - 1);
    const int last_y = std::min(static_cast<int>(bottom), shape.grid.height - 1);
    for (int y = static_cast<int>(std::ceil(top)); y <= last_y; ++y)
        for (int x = static_cast<int>(std::ceil(left)); x <= last_x; ++x) {
            const Point at{static_cast<double>(x), static_cast<double>(y)};
            const std::array<double, 3> w{cross(p[1], p[2], at) / area, cross(p[2], p[0], at) / area,
                                          cross(p[0], p[1], at) / area};
            if (w[0] < 0 || w[1] < 0 || w[2] < 0) continue;
            visit(as_index(y) * as_index(shape.grid.width) + as_index(x), w);
        }
}

}  // namespace

std::vector<FaceMoments> face_moments(const CodedShape& shape, std::span<const float> picture, int channels,
                                      std::span<const float> weights) {
    const std::size_t depth = as_index(channels);
    std::vector<Id> owner(as_index(shape.grid.width) * as_index(shape.grid.height), kNone);
    for (std::size_t f = 0; f < shape.faces.size(); ++f)
        visit_pixels(shape, corners_of(shape, shape.faces[f]),
                     [&](std::size_t pixel, const auto&) { owner[pixel] = as_id(f); });
    std::vector<FaceMoments> out(shape.faces.size());
    for (std::size_t f = 0; f < shape.faces.size(); ++f)
        visit_pixels(shape, corners_of(shape, shape.faces[f]),
                     [&](std::size_t pixel, const std::array<double, 3>& w) {
                         if (owner[pixel] != f) return;
                         FaceMoments& m = out[f];
                         const double weight = weights.empty() ? 1 : double{weights[pixel]};
                         ++m.pixels;
                         for (std::size_t i = 0; i < 3; ++i)
                             for (std::size_t j = 0; j < 3; ++j) m.ww[i][j] += weight * (w[i] * w[j]);
                         for (std::size_t c = 0; c < depth; ++c) {
                             const double value = picture[pixel * depth + c], weighed = weight * value;
                             for (std::size_t i = 0; i < 3; ++i) m.wi[i][c] += w[i] * weighed;
                             m.ii += weighed * value;
                         }
                     });
    return out;
}

}  // namespace imgmesh::coding
