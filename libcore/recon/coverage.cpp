// Sutherland and Hodgman's clipping, one line at a time; areas and centroids by the shoelace formula.
#include "libcore/recon/coverage.h"

#include <algorithm>
#include <limits>

namespace imgmesh {

std::pair<double, double> CutPolygon::extent(int axis) const {
    double least = corners_[0][axis], most = least;
    for (std::size_t i = 1; i < size_; ++i) {
        least = std::min(least, corners_[i][axis]);
        most = std::max(most, corners_[i][axis]);
    }
    return {least, most};
}

CutPolygon CutPolygon::cut_off(int axis, double at) {
    CutPolygon below, above;
    for (std::size_t i = 0; i < size_; ++i) {
        const Vec2d &p = corners_[i], &q = corners_[i + 1 < size_ ? i + 1 : 0];
        if (p[axis] <= at) below.append(p);
        if (p[axis] >= at) above.append(p);
        if ((p[axis] < at) == (q[axis] < at) || p[axis] == at || q[axis] == at) continue;
        Vec2d cut = p + (q - p) * ((at - p[axis]) / (q[axis] - p[axis]));
        cut[axis] = at;
        below.append(cut);
        above.append(cut);
    }
    // What only touches the line has no area.
    if (above.size_ < 3 || above.extent(axis).second <= at) above.size_ = 0;
    if (below.size_ < 3 || below.extent(axis).first >= at) below.size_ = 0;
    *this = above;
    return below;
}

std::pair<double, double> CutPolygon::extent_at(double y) const {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    double least = kInfinity, most = -kInfinity;
    for (std::size_t i = 0; i < size_; ++i) {
        if (corners_[i].y() != y) continue;
        least = std::min(least, corners_[i].x());
        most = std::max(most, corners_[i].x());
    }
    return {least, most};
}

std::pair<double, Vec2d> CutPolygon::area() const {
    if (size_ < 3) return {0, Vec2d(0, 0)};
    // From the first corner, so that the numbers are small.
    const Vec2d& origin = corners_[0];
    double twice = 0;
    Vec2d moment(0, 0), sum(0, 0);
    for (std::size_t i = 1; i + 1 < size_; ++i) {
        const Vec2d p = corners_[i] - origin, q = corners_[i + 1] - origin;
        const double cross = p.x() * q.y() - p.y() * q.x();
        twice += cross;
        moment += cross * (p + q);
        sum += p;
    }
    sum += corners_[size_ - 1] - origin;
    // Of the thinnest, rounding leaves no more than the place.
    constexpr double kThin = 1e-9;
    const double area = std::abs(twice) / 2;
    const Vec2d centroid = area > kThin ? Vec2d(moment / (3 * twice)) : Vec2d(sum / double(size_));
    return {area, origin + centroid};
}

}  // namespace imgmesh
