// Which part of each pixel a triangle covers, exactly. Drawings that sum colours by covered area have neither
// stairs nor hairlines.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

#include "libcore/base/types.h"

namespace imgmesh {

/// A convex polygon that lines along pixels cut out of a triangle: at most seven corners.
class CutPolygon {
  public:
    CutPolygon() = default;
    CutPolygon(const Vec2d& a, const Vec2d& b, const Vec2d& c) : size_(3), corners_{a, b, c} {}

    bool empty() const { return size_ == 0; }
    /// Returns the least and the largest coordinate, 0 along x and 1 along y. Not for an empty one.
    std::pair<double, double> extent(int axis) const;
    /// Returns the part below `at` along `axis`, and keeps the part above.
    CutPolygon cut_off(int axis, double at);
    /// Returns the least and the largest x of the corners at exactly this y; first > second if there is none.
    std::pair<double, double> extent_at(double y) const;
    /// Returns the area, at least 0, and the centroid.
    std::pair<double, Vec2d> area() const;

  private:
    void append(const Vec2d& p) { corners_[size_++] = p; }

    std::size_t size_ = 0;
    std::array<Vec2d, 8> corners_;
};

/// Calls add(x, y, area, centroid) for every pixel of the rows [first_row, last_row) and the columns [0,
/// width) that the triangle covers a part of: `area` is that part, above 0 and at most 1. Pixel (x, y) is the
/// square from (x, y) to (x + 1, y + 1). The order is fixed. Takes O(pixels + rows) time.
template <typename Add>
void for_each_covered(const std::array<Vec2d, 3>& triangle, int first_row, int last_row, int width,
                      Add&& add);

}  // namespace imgmesh

#include "libcore/recon/coverage_rows.h"
