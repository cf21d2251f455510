// The polygon with fewest points follows P. Selinger, "Potrace: a polygon-based tracing algorithm", 2003:
// here each segment must pass between the two pixels of every edge that it stands for.
#include "libcore/segment/smooth_line.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

// Coordinates are written with two decimals, so lines keep this distance from pixels' centres [pixels].
constexpr double kMargin = 0.02;

// Points of a polygon are sought this far ahead. Longer straight pieces have a few points more.
constexpr std::size_t kLongest = 256;

// A rounded corner is at most this far from the polygon's corner [pixels], and the less the sharper it is:
// curves, which consist of blunt corners, become smooth, and corners stay corners.
constexpr double kRounding = 0.45;
// ... and begins at most so far from it, which bounds the work of looking for centres.
constexpr double kArm = 8;

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

// A place that a polygon may have a point at: the middle of a pixel edge, or an end of the line. A segment
// that passes by crosses from `left` to `right`.
struct Place {
    Vec2d at = Vec2d::Zero();
    Vec2d left = Vec2d::Zero();
    Vec2d right = Vec2d::Zero();
    bool edge = true;  // not an end
};

// Places in the order of the line; a closed one begins and ends with the same.
std::vector<Place> places_of(const std::vector<Vec2d>& corners, bool closed, double reach) {
    std::vector<Place> places;
    const auto end = [&](const Vec2d& at) { places.push_back({at, at, at, false}); };
    if (!closed) end(corners.front());
    for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
        const Vec2d along = corners[i + 1] - corners[i], left(along.y(), -along.x());
        const Vec2d middle = (corners[i] + corners[i + 1]) / 2;
        places.push_back({middle, middle + reach * left, middle - reach * left, true});
    }
    if (closed)
        places.push_back(places.front());
    else
        end(corners.back());
    return places;
}

// Sums over places 0 to i - 1, for distances to straight lines.
class Moments {
  public:
    explicit Moments(const std::vector<Place>& places) : first_(places.size() + 1), second_(first_.size()) {
        first_[0].setZero();
        second_[0].setZero();
        for (std::size_t i = 0; i < places.size(); ++i) {
            const Vec2d p = places[i].at - places[0].at;
            first_[i + 1] = first_[i] + p;
            second_[i + 1] = second_[i] + Vec3d(p.x() * p.x(), p.x() * p.y(), p.y() * p.y());
        }
        origin_ = places[0].at;
    }
    // The sum of the squared distances of places i to j from the line through i and j.
    double misfit(const std::vector<Place>& places, std::size_t i, std::size_t j) const {
        const Vec2d p = places[i].at - origin_, d = places[j].at - places[i].at;
        const double length = d.squaredNorm();
        if (length == 0) return 0;
        const double count = double(j - i + 1);
        const Vec2d f = first_[j + 1] - first_[i];
        const Vec3d s = second_[j + 1] - second_[i];
        const double xx = s[0] - 2 * p.x() * f.x() + count * p.x() * p.x();
        const double xy = s[1] - p.x() * f.y() - p.y() * f.x() + count * p.x() * p.y();
        const double yy = s[2] - 2 * p.y() * f.y() + count * p.y() * p.y();
        return std::max(0.0, (d.y() * d.y() * xx - 2 * d.x() * d.y() * xy + d.x() * d.x() * yy) / length);
    }

  private:
    Vec2d origin_;
    std::vector<Vec2d> first_;
    std::vector<Vec3d> second_;
};

// The places of the polygon with fewest points from the first place to the last; among these the one nearest
// to the places between.
std::vector<std::size_t> best_polygon(const std::vector<Place>& places) {
    struct Best {
        std::size_t segments = std::numeric_limits<std::size_t>::max();
        double misfit = 0;
        std::size_t from = 0;
    };
    const Moments moments(places);
    std::vector<Best> best(places.size());
    best[0].segments = 0;
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
        // Directions from place i that pass between the pixels of all edges so far.
        Vec2d most_left = Vec2d::Zero(), most_right = Vec2d::Zero();
        bool any = true;
        for (std::size_t j = i + 1; j < std::min(places.size(), i + kLongest + 1) && any; ++j) {
            const Vec2d to = places[j].at - places[i].at;
            const Vec2d left = places[j].left - places[i].at, right = places[j].right - places[i].at;
            const bool first = j == i + 1;
            // On screen y grows down: b is to the left of a where the cross product is negative.
            const bool inside = first || (cross(most_left, to) >= 0 && cross(most_right, to) <= 0);
            const bool forward = !places[j].edge || (cross(to, left) < 0 && cross(to, right) > 0);
            if (inside && forward && to.squaredNorm() > 0) {
                const std::size_t segments = best[i].segments + 1;
                const double misfit = best[i].misfit + moments.misfit(places, i, j);
                if (segments < best[j].segments || (segments == best[j].segments && misfit < best[j].misfit))
                    best[j] = {segments, misfit, i};
            }
            if (first || cross(most_left, left) > 0) most_left = left;
            if (first || cross(most_right, right) < 0) most_right = right;
            any = cross(most_left, most_right) > 0;
        }
    }
    std::vector<std::size_t> chosen = {places.size() - 1};
    while (chosen.back() != 0) chosen.push_back(best[chosen.back()].from);
    std::reverse(chosen.begin(), chosen.end());
    return chosen;
}

// Whether rounding a corner cuts off a pixel's centre, or nearly: whether one lies between the corner and the
// parabola from `a` to `b` whose control point is the corner.
bool cuts_off_center(const Vec2d& a, const Vec2d& corner, const Vec2d& b) {
    const double area = cross(b - a, corner - a);
    if (area == 0) return false;
    const Vec2d low = a.cwiseMin(b).cwiseMin(corner), high = a.cwiseMax(b).cwiseMax(corner);
    const Vec2d shift = kMargin * (corner - (a + b) / 2).normalized();
    for (double y = std::ceil(low.y() - 0.5 - kMargin) + 0.5; y <= high.y() + kMargin; ++y)
        for (double x = std::ceil(low.x() - 0.5 - kMargin) + 0.5; x <= high.x() + kMargin; ++x) {
            // Weights of the triangle's corners; on the parabola they are (1 - t)^2, 2 t (1 - t) and t^2.
            const Vec2d p = Vec2d(x, y) + shift;
            const double at_corner = cross(b - a, p - a) / area;
            const double at_a = cross(corner - b, p - b) / area, at_b = 1 - at_corner - at_a;
            const double slack = kMargin * ((corner - a).norm() + (corner - b).norm()) / std::abs(area);
            const bool inside = at_a >= -slack && at_b >= -slack && at_corner >= 0 && at_corner <= 1 + slack;
            if (inside && at_corner * at_corner >= 4 * at_a * at_b) return true;
        }
    return false;
}

// How far from `corner` its rounding begins, towards both neighbours; 0 for a sharp corner.
double arm_of(const Vec2d& before, const Vec2d& corner, const Vec2d& after) {
    const Vec2d in = corner - before, out = after - corner;
    const double half = std::min(in.norm(), out.norm()) / 2;
    const Vec2d from = -in.normalized(), to = out.normalized();
    const double sine = (from + to).norm() / 2;  // of half the turn
    if (sine < 1e-6) return 0;                   // straight on
    double arm = std::min({half, kArm, 2 * kRounding * (1 - sine * sine) / sine});
    for (int tries = 0; tries < 8; ++tries, arm *= 0.75)
        if (!cuts_off_center(corner + arm * from, corner, corner + arm * to)) return arm;
    return 0;
}

void append_line(OutlineArc& arc, const Vec2d& end) {
    const Vec2d& last = arc.steps.empty() ? arc.start : arc.steps.back().end;
    if (last != end) arc.steps.push_back({false, Vec2d::Zero(), end});
}

void append_corner(OutlineArc& arc, const Vec2d& before, const Vec2d& corner, const Vec2d& after) {
    const double arm = arm_of(before, corner, after);
    append_line(arc, corner - arm * (corner - before).normalized());
    if (arm > 0) arc.steps.push_back({true, corner, corner + arm * (after - corner).normalized()});
}

std::vector<Vec2d> without_straight(const std::vector<Vec2d>& corners) {
    std::vector<Vec2d> kept = {corners.front()};
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        if (corners[i + 1] - corners[i] != corners[i] - corners[i - 1]) kept.push_back(corners[i]);
    kept.push_back(corners.back());
    return kept;
}

}  // namespace

OutlineArc smooth_line(const std::vector<Vec2d>& corners, bool closed, double tolerance) {
    OutlineArc arc;
    if (tolerance == 0) {
        const std::vector<Vec2d> kept = without_straight(corners);
        arc.start = kept.front();
        for (std::size_t i = 1; i < kept.size(); ++i) append_line(arc, kept[i]);
        return arc;
    }
    std::vector<Place> places = places_of(corners, closed, std::max(tolerance - kMargin, kMargin));
    std::vector<std::size_t> chosen = best_polygon(places);
    if (closed && chosen.size() > 2) {
        // The first point was no choice. One that was chosen becomes the first, and the rest is chosen anew.
        places.pop_back();
        std::rotate(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(chosen[chosen.size() / 2]),
                    places.end());
        places.push_back(places.front());
        chosen = best_polygon(places);
    }
    std::vector<Vec2d> points;
    for (const std::size_t i : chosen) points.push_back(places[i].at);
    const std::size_t last = points.size() - 1;
    if (closed) {
        // It begins behind its first corner, which is rounded in the end.
        const Vec2d out = points[1] - points[0];
        arc.start = points[0] + arm_of(points[last - 1], points[0], points[1]) * out.normalized();
        for (std::size_t i = 1; i < last; ++i) append_corner(arc, points[i - 1], points[i], points[i + 1]);
        append_corner(arc, points[last - 1], points[last], points[1]);
        append_line(arc, arc.start);
    } else {
        arc.start = points[0];
        for (std::size_t i = 1; i < last; ++i) append_corner(arc, points[i - 1], points[i], points[i + 1]);
        append_line(arc, points[last]);
    }
    return arc;
}

}  // namespace imgmesh
