#include "libcore/param/collapse_flattening.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "libcore/base/index.h"

namespace imgmesh {
namespace {

std::size_t index(int k) {
    return as_index(k);
}

int size(const OneRing& ring) {
    return static_cast<int>(ring.vertices());
}

std::span<const Vec2d> ring_of(const FlatRing& flat, int size) {
    return {flat.at.data(), index(size)};
}

// A point of the fan around `center` in the plane.
Vec2d position(const Vec2d& center, std::span<const Vec2d> ring, const FanPoint& point) {
    const std::size_t k = index(point.triangle), next = k + 1 < ring.size() ? k + 1 : 0;
    return point.weight[0] * center + point.weight[1] * ring[k] + point.weight[2] * ring[next];
}

// Returns the place of a point in the image, with y up as in layouts.
Vec2d plane(const float* point) {
    return {double(point[0]), -double(point[1])};
}

double cross(const Vec2d& a, const Vec2d& b) {
    return a.x() * b.y() - a.y() * b.x();
}

double plane_distance(const float* a, const float* b) {
    return (plane(a) - plane(b)).squaredNorm();
}

double angle_at(const float* pivot, const float* a, const float* b, int dimensions) {
    double aa = 0, bb = 0, ab = 0;
    for (int c = 0; c < dimensions; ++c) {
        const double d = double(a[c]) - double(pivot[c]), e = double(b[c]) - double(pivot[c]);
        aa += d * d;
        bb += e * e;
        ab += d * e;
    }
    return std::acos(std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0));
}

// Returns the points of a star's ring.
std::array<const float*, kMaxFlatRing> ring_points(const OneRing& star, const float* points, int dimensions) {
    assert(star.vertices() <= kMaxFlatRing);
    std::array<const float*, kMaxFlatRing> out{};
    for (std::size_t k = 0; k < star.vertices(); ++k)
        out[k] = points + std::size_t{star.vertex[k]} * index(dimensions);
    return out;
}

const float* center_point(const OneRing& star, const float* points, int dimensions) {
    return points + std::size_t{star.center} * index(dimensions);
}

}  // namespace

bool CollapseFlattening::is_shared(int star, int face) const {
    const int at = other_[index(star)];
    const OneRing& s = *stars_[index(star)];
    return face == at || face == (at > 0 || !s.closed ? at - 1 : size(s) - 1);
}

bool CollapseFlattening::lay_out(const std::array<const OneRing*, 2>& stars, const float* points,
                                 const float* merged, int dimensions, bool shared) {
    stars_ = stars;
    std::array<bool, 2> at_end{};
    for (std::size_t s = 0; s < 2; ++s) {
        other_[s] = stars[s]->find(stars[1 - s]->center);
        at_end[s] = plane_distance(merged, center_point(*stars[s], points, dimensions)) == 0;
    }
    if (at_end[0] || at_end[1]) {
        mode_ = Mode::kOneEnd;
        pivot_ = at_end[0] ? 0 : 1;
        return lay_out_star(1 - pivot_, points, merged, dimensions);
    }
    const auto lay_out_around = [&](int pivot) {
        mode_ = Mode::kMove;
        pivot_ = pivot;
        return lay_out_move(points, merged, dimensions) &&
               lay_out_star(1 - pivot, points, merged, dimensions);
    };
    if (stars[0]->closed != stars[1]->closed) return lay_out_around(stars[0]->closed ? 1 : 0);
    if (!in_shared_region(points, merged, dimensions)) {
        const int nearer = plane_distance(merged, center_point(*stars[0], points, dimensions)) <=
                                   plane_distance(merged, center_point(*stars[1], points, dimensions))
                               ? 0
                               : 1;
        if (lay_out_around(nearer) || lay_out_around(1 - nearer)) return true;
    }
    mode_ = Mode::kBetween;
    return (!shared || lay_out_shared(points, merged, dimensions)) &&
           lay_out_star(0, points, merged, dimensions) && lay_out_star(1, points, merged, dimensions);
}

// Returns whether m lies inside the shared faces, or between the ends of a border edge, in the plane.
bool CollapseFlattening::in_shared_region(const float* points, const float* merged, int dimensions) const {
    const OneRing& i = *stars_[0];
    const auto place = [&](Id v) { return plane(points + std::size_t{v} * index(dimensions)); };
    const Vec2d m = plane(merged), pi = place(i.center), pj = place(stars_[1]->center);
    if (!i.closed) return (pi - m).dot(pj - m) < 0;
    const int at = other_[0];
    const Vec2d ring[] = {pj, place(i.vertex[index((at + 1) % size(i))]), pi,
                          place(i.vertex[index((at + size(i) - 1) % size(i))])};
    for (std::size_t k = 0; k < 4; ++k)
        if (!(cross(ring[k] - m, ring[(k + 1) % 4] - m) > 0)) return false;
    return true;
}

bool CollapseFlattening::lay_out_shared(const float* points, const float* merged, int dimensions) {
    const OneRing& i = *stars_[0];
    const auto point = [&](Id v) { return points + std::size_t{v} * index(dimensions); };
    const float *pi = point(i.center), *pj = point(stars_[1]->center);
    const int at = other_[0];
    std::array<const float*, 4> ring{};
    if (i.closed) {  // j, a, i, b
        ring = {pj, point(i.vertex[index((at + 1) % size(i))]), pi,
                point(i.vertex[index((at + size(i) - 1) % size(i))])};
    } else if (at == 0) {  // face (i, j, a): the border runs from j to i
        ring = {pj, point(i.vertex[1]), pi};
    } else {  // face (i, b, j): from i to j
        ring = {pi, point(i.vertex[index(at - 1)]), pj};
    }
    const int n = i.closed ? 4 : 3;
    if (!flatten_ring(merged, {ring.data(), index(n)}, dimensions, !i.closed, shared_ring_)) return false;
    const std::array<Vec2d, kMaxFlatRing>& p = shared_ring_.at;
    FlatFan before;  // the old faces, as fans of the ring's first vertex
    const std::array<Vec2d, 3> rest{p[1], p[2], p[3]};
    return before.set(p[0], std::span(rest).first(index(n - 1)), false) &&
           shared_fan_.set(Vec2d::Zero(), ring_of(shared_ring_, n), i.closed);
}

bool CollapseFlattening::lay_out_move(const float* points, const float* merged, int dimensions) {
    const OneRing& star = *stars_[index(pivot_)];
    const auto ring = ring_points(star, points, dimensions);
    if (!flatten_ring(merged, {ring.data(), star.vertices()}, dimensions, !star.closed, move_ring_))
        return false;
    // The end lies between two ring vertices as seen from m in the plane; on a border, along it.
    const float* end = center_point(star, points, dimensions);
    const Vec2d toward = plane(end) - plane(merged);
    const std::span<const Vec2d> flat = ring_of(move_ring_, size(star));
    double distance = 0;
    for (int c = 0; c < dimensions; ++c)
        distance += (double(end[c]) - double(merged[c])) * (double(end[c]) - double(merged[c]));
    const double radius = std::pow(std::sqrt(distance) / move_ring_.mean, move_ring_.exponent);
    if (!star.closed) {
        move_end_ = {toward.dot(plane(ring[0]) - plane(merged)) > 0 ? radius : -radius, 0};
    } else {
        int k = 0;
        const auto leads_to = [&](int r) {
            const Vec2d first = plane(ring[index(r)]) - plane(merged),
                        second = plane(ring[index((r + 1) % size(star))]) - plane(merged);
            return cross(first, toward) >= 0 && cross(toward, second) > 0 && cross(first, second) > 0;
        };
        while (k < size(star) && !leads_to(k)) ++k;
        if (k == size(star)) return false;
        const float *first = ring[index(k)], *second = ring[index((k + 1) % size(star))];
        const double before = angle_at(merged, first, end, dimensions),
                     after = angle_at(merged, end, second, dimensions);
        // The sector's share on this side of the end.
        const Vec2d &from = flat[index(k)], &to = flat[index((k + 1) % size(star))];
        const double start = std::atan2(from.y(), from.x());
        const double width = std::atan2(cross(from, to), from.dot(to));
        const double direction = start + width * (before + after > 0 ? before / (before + after) : 0.5);
        move_end_ = {radius * std::cos(direction), radius * std::sin(direction)};
    }
    FlatFan before;
    return before.set(move_end_, flat, star.closed) && move_fan_.set(Vec2d::Zero(), flat, star.closed);
}

bool CollapseFlattening::lay_out_star(int s, const float* points, const float* merged, int dimensions) {
    const OneRing& star = *stars_[index(s)];
    auto ring = ring_points(star, points, dimensions);
    ring[index(other_[index(s)])] = merged;
    FlatRing& flat = star_ring_[index(s)];
    if (size(star) < 3 || !flatten_ring(center_point(star, points, dimensions),
                                        {ring.data(), star.vertices()}, dimensions, !star.closed, flat))
        return false;
    FlatFan before;
    if (!before.set(Vec2d::Zero(), ring_of(flat, size(star)), star.closed)) return false;
    // On a border m is the first or the last of the ring, and its fan begins after it or ends before it.
    const int at = other_[index(s)], first = !star.closed && at > 0 ? 0 : at + 1;
    assert(star.closed || at == 0 || at == size(star) - 1);
    std::array<Vec2d, kMaxFlatRing> rest;
    for (int k = 0; k + 1 < size(star); ++k) rest[index(k)] = flat.at[index((first + k) % size(star))];
    return star_fan_[index(s)].set(flat.at[index(at)], {rest.data(), index(size(star) - 1)}, false);
}

// Step 2 for one point.
FanPoint CollapseFlattening::without_end(int s, const FanPoint& point) const {
    const OneRing& star = *stars_[index(s)];
    const Vec2d p = position(Vec2d::Zero(), ring_of(star_ring_[index(s)], size(star)), point);
    FanPoint found = star_fan_[index(s)].locate(p);
    const int at = other_[index(s)], first = !star.closed && at > 0 ? 0 : at + 1;
    found.triangle = (found.triangle + first) % size(star);
    return found;
}

// A point of a shared face, seen from the other end: face (i, j, a) of one end is (j, a, i) of the other.
StarPoint CollapseFlattening::in_other_star(const StarPoint& point) const {
    const int s = point.star, o = 1 - s;
    const auto& w = point.at.weight;
    const OneRing& other = *stars_[index(o)];
    const int at = other_[index(o)];
    if (point.at.triangle == other_[index(s)])
        return {o, {at > 0 || !other.closed ? at - 1 : size(other) - 1, {w[1], w[2], w[0]}}};
    return {o, {at, {w[2], w[0], w[1]}}};
}

// Step 1 for one point: to a face of either star, with m in the place of the other end.
StarPoint CollapseFlattening::across_shared(const StarPoint& given) const {
    const StarPoint point = given.star == 0 ? given : in_other_star(given);
    const OneRing& i = *stars_[0];
    const int at = other_[0];
    const auto& p = shared_ring_.at;
    const auto& w = point.at.weight;  // of i, and of j and a, or b and j
    const bool after = point.at.triangle == at;
    Vec2d place;
    if (i.closed)
        place = after ? w[0] * p[2] + w[1] * p[0] + w[2] * p[1] : w[0] * p[2] + w[1] * p[3] + w[2] * p[0];
    else
        place = at == 0 ? w[0] * p[2] + w[1] * p[0] + w[2] * p[1] : w[0] * p[0] + w[1] * p[1] + w[2] * p[2];
    const FanPoint found = shared_fan_.locate(place);
    const auto& [m, first, second] = found.weight;
    // The ring is j, a, i, b, or half of it that begins at j or at i.
    const int triangle = !i.closed && at > 0 ? found.triangle + 2 : found.triangle;
    const auto before = [&](int s) {
        const OneRing& star = *stars_[index(s)];
        const int k = other_[index(s)];
        return k > 0 || !star.closed ? k - 1 : size(star) - 1;
    };
    switch (triangle) {
        case 0:  // m, j, a
            return {1, {before(1), {first, second, m}}};
        case 1:  // m, a, i
            return {0, {other_[0], {second, m, first}}};
        case 2:  // m, i, b
            return {0, {before(0), {first, second, m}}};
        default:  // m, b, j
            return {1, {other_[1], {second, m, first}}};
    }
}

FanPoint CollapseFlattening::moved(const FanPoint& point) const {
    return move_fan_.locate(position(move_end_, ring_of(move_ring_, size(*stars_[index(pivot_)])), point));
}

StarPoint CollapseFlattening::carry(StarPoint point) const {
    if (mode_ == Mode::kBetween) {
        // An end itself has a triangle of its own star, perhaps a shared one, but its place is known.
        if (point.at.weight[0] != 1 && is_shared(point.star, point.at.triangle)) point = across_shared(point);
    } else if (mode_ == Mode::kMove) {
        if (point.star != pivot_ && is_shared(point.star, point.at.triangle)) point = in_other_star(point);
        if (point.star == pivot_) {
            point.at = moved(point.at);
            if (!is_shared(pivot_, point.at.triangle)) return point;
            point = in_other_star(point);
        }
    } else if (point.star == pivot_) {
        assert(is_shared(point.star, point.at.triangle));
        point = in_other_star(point);
    }
    point.at = without_end(point.star, point.at);
    return point;
}

}  // namespace imgmesh
