// The pixels of a triangle as spans. The faces of a mesh divide its pixels among them: each counts once.
#pragma once

#include <algorithm>
#include <utility>

#include "libcore/base/simd.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The first pixel of a row that is not left of an edge. It is exact, because positions are multiples of 1/32
/// px: numerators stay below 2^53, and a quotient that is not whole differs from every whole number by more
/// than a double's rounding.
struct SpanEdge {
    double numerator = 0, per_row = 0, denominator = 1;

    SpanEdge() = default;
    SpanEdge(const Vec2f& top, const Vec2f& bottom) {
        const double px = double(top.x()) * 32, py = double(top.y()) * 32;
        const double dx = double(bottom.x()) * 32 - px, dy = double(bottom.y()) * 32 - py;
        numerator = px * dy - py * dx;
        per_row = 32 * dx;
        denominator = 32 * dy;
    }
    IMGMESH_INLINE int first_pixel(int y, int width) const {
        const double x = (numerator + y * per_row) / denominator;
        int i = static_cast<int>(x);
        i += i < x;
        return i + (x == width - 1);
    }
};

/// Calls row(y, begin, end) for the pixels (begin..end-1, y) of a face of positive area, in ascending
/// rows.
///
/// A pixel whose centre lies on an edge belongs to the face just to the right of its centre and, far less,
/// below; in the last column just to the left, in the last row just above. So each pixel of a mesh that
/// covers the whole width x height image is in exactly one face.
template <class Row>
IMGMESH_INLINE void for_each_span(const Vec2f& a, const Vec2f& b, const Vec2f& c, int width, int height,
                                  Row&& row) {
    const Vec2f *top = &a, *middle = &b, *bottom = &c;
    if (middle->y() < top->y()) std::swap(top, middle);
    if (bottom->y() < middle->y()) std::swap(middle, bottom);
    if (middle->y() < top->y()) std::swap(top, middle);
    const SpanEdge full(*top, *bottom), upper(*top, *middle), lower(*middle, *bottom);
    const bool middle_left = signed_area2(*top, *middle, *bottom) > 0;
    const auto reached = [height](int y, float at) {
        return static_cast<float>(y) > at || (static_cast<float>(y) == at && y != height - 1);
    };
    int y = std::max(0, static_cast<int>(top->y()));
    while (!reached(y, top->y())) ++y;
    for (; y < height && !reached(y, bottom->y()); ++y) {
        const SpanEdge& part = reached(y, middle->y()) ? lower : upper;
        const SpanEdge &left = middle_left ? part : full, &right = middle_left ? full : part;
        const int begin = std::max(0, left.first_pixel(y, width));
        const int end = std::min(width, right.first_pixel(y, width));
        if (begin < end) row(y, begin, end);
    }
}

}  // namespace imgmesh
