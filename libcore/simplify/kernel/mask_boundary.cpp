// Source: progressive hulls (Sander, Gu, Gortler, Hoppe and Snyder, "Silhouette clipping", 2000), in the
// plane and by exact tests. Boundaries run with the inside on their left.
#include "libcore/simplify/kernel/mask_boundary.h"

#include <algorithm>
#include <cmath>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {
namespace {

// A point q is left of p -> r where this is positive; exact on the kPositionStep grid.
double turn(const Vec2f& p, const Vec2f& q, const Vec2f& r) {
    return signed_area2(p, q, r);
}

double squared_distance(const Vec2f& p, const Vec2f& a, const Vec2f& b) {
    const Vec2d d = (b - a).cast<double>(), e = (p - a).cast<double>();
    const double length2 = d.squaredNorm();
    const double t = length2 > 0 ? std::clamp(e.dot(d) / length2, 0.0, 1.0) : 0.0;
    return (e - t * d).squaredNorm();
}

constexpr double kBand2 = double{kBoundaryBand} * kBoundaryBand;

bool on_segment(const Vec2f& p, const Vec2f& a, const Vec2f& b) {
    return turn(a, b, p) == 0 && std::min(a.x(), b.x()) <= p.x() && p.x() <= std::max(a.x(), b.x()) &&
           std::min(a.y(), b.y()) <= p.y() && p.y() <= std::max(a.y(), b.y());
}

// Whether two closed segments share a point.
bool segments_meet(const Vec2f& a, const Vec2f& b, const Vec2f& c, const Vec2f& d) {
    const auto sign = [](double x) { return (x > 0) - (x < 0); };
    const int s1 = sign(turn(a, b, c)), s2 = sign(turn(a, b, d)), s3 = sign(turn(c, d, a)),
              s4 = sign(turn(c, d, b));
    if (s1 * s2 < 0 && s3 * s4 < 0) return true;
    return on_segment(c, a, b) || on_segment(d, a, b) || on_segment(a, c, d) || on_segment(b, c, d);
}

// Whether the segment p, q shares a point with the closed counter-clockwise triangle t. An end of the segment
// that is a corner of the triangle does not count.
bool enters(const Vec2f& p, const Vec2f& q, const std::array<Vec2f, 3>& t) {
    for (const auto& [end, other] : {std::pair(&p, &q), std::pair(&q, &p)})
        for (std::size_t k = 0; k < 3; ++k) {
            if (t[k] != *end) continue;
            // From a corner on, it is inside where it starts between the two sides.
            return turn(t[k], t[(k + 1) % 3], *other) >= 0 && turn(t[(k + 2) % 3], t[k], *other) >= 0;
        }
    const auto inside = [&](const Vec2f& r) {
        return turn(t[0], t[1], r) >= 0 && turn(t[1], t[2], r) >= 0 && turn(t[2], t[0], r) >= 0;
    };
    return inside(p) || inside(q) || segments_meet(p, q, t[0], t[1]) || segments_meet(p, q, t[1], t[2]) ||
           segments_meet(p, q, t[2], t[0]);
}

// What the mesh gains when b and c of the boundary a, b, c, d are replaced by m.
std::array<std::array<Vec2f, 3>, 3> gains(const Vec2f& a, const Vec2f& b, const Vec2f& c, const Vec2f& d,
                                          const Vec2f& m) {
    return {{{a, m, b}, {b, m, c}, {c, m, d}}};
}

}  // namespace

MaskBoundary::MaskBoundary(const GridMesh& grid, const RingMesh& rings, const std::vector<Id>& number)
    : grid_(grid), first_point_(grid.vertex_count(), kNone), point_(rings.size(), kNone) {
    for (Id v = 0; v < rings.size(); ++v)
        if (rings[v].live() && rings[v].border()) {
            const Id n = point_[v] = static_cast<Id>(points_.size());
            const Id dense = number.empty() ? v : number[v];
            first_point_[dense] = n;
            points_.push_back({{rings[v].x, rings[v].y}, grid.pixel_of(dense), kNone, n, v, n, 0});
        }
    for (Point& point : points_) point.next = point_[rings[point.vertex].neighbor[0]];
}

MaskBoundary::Sides MaskBoundary::sides(const RingMesh& rings, Id i, Id j) {
    const bool forward = rings[i].neighbor[0] == j;
    const Id b = forward ? i : j, c = forward ? j : i;
    return {rings[b].neighbor[rings[b].valence - 1], b, c, rings[c].neighbor[0]};
}

MaskBoundary::Places MaskBoundary::places(const RingMesh& rings, Id i, Id j, float x, float y) const {
    const Sides s = sides(rings, i, j);
    const auto at = [&](Id v) { return Vec2f(rings[v].x, rings[v].y); };
    const Vec2f a = at(s.a), b = at(s.b), c = at(s.c), d = at(s.d);
    Places out;
    const auto consider = [&](const Vec2f& m) {
        for (const auto& [p, q, r] : gains(a, b, c, d, m))
            if (!(turn(p, q, r) >= 0)) return;
        out.at[static_cast<std::size_t>(out.count++)] = m;
    };
    consider(b);
    consider(c);
    const Vec2f free(snapped(x), snapped(y));
    consider(free);
    if (turn(a, b, c) == 0 && turn(b, c, d) == 0) {
        if (a.x() == b.x() && b.x() == c.x()) consider({a.x(), free.y()});
        if (a.y() == b.y() && b.y() == c.y()) consider({free.x(), a.y()});
        return out;
    }
    // Where the lines a b and c d meet; of the grid points around it the first that cuts nothing off.
    const Vec2d along = (b - a).cast<double>(), back = (c - d).cast<double>();
    const double cross = along.x() * back.y() - along.y() * back.x();
    if (cross == 0) return out;
    const Vec2d offset = (c - a).cast<double>();
    const double t = (offset.x() * back.y() - offset.y() * back.x()) / cross;
    const Vec2d meet = (a.cast<double>() + t * along) / double{kPositionStep};
    if (!((meet * double{kPositionStep} - b.cast<double>()).norm() < 2)) return out;
    const int before = out.count;
    for (const bool up : {false, true})
        for (const bool right : {false, true})
            if (out.count == before)
                consider(kPositionStep *
                         Vec2f(static_cast<float>(right ? std::ceil(meet.x()) : std::floor(meet.x())),
                               static_cast<float>(up ? std::ceil(meet.y()) : std::floor(meet.y()))));
    return out;
}

void MaskBoundary::collect_chain(const Sides& s) {
    chain_.clear();
    const Id last = points_[point_[s.d]].anchor;
    Id n = points_[point_[s.a]].anchor;
    do {
        chain_.push_back(n);
        n = points_[n].next;
    } while (n != last);
    chain_.push_back(last);
}

// The index in chain_, its ends left out.
std::size_t MaskBoundary::nearest_in_chain(float x, float y) const {
    std::size_t best = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k + 1 < chain_.size(); ++k) {
        const double distance = (points_[chain_[k]].position - Vec2f(x, y)).cast<double>().squaredNorm();
        if (distance < least) {
            least = distance;
            best = k;
        }
    }
    return best;
}

// A point of the new edge a m lies between the projections of two points of the chain on it, or between an
// end and the nearest such projection; so it too is within the band of the chain.
bool MaskBoundary::within_band(const RingMesh& rings, const Sides& s, const Vec2f& m) const {
    const std::size_t middle = nearest_in_chain(m.x(), m.y());
    if ((points_[chain_[middle]].position - m).cast<double>().squaredNorm() > kBand2) return false;
    const Vec2f a(rings[s.a].x, rings[s.a].y), d(rings[s.d].x, rings[s.d].y);
    for (std::size_t k = 0; k < chain_.size(); ++k) {
        const Vec2f& p = points_[chain_[k]].position;
        if ((k <= middle && squared_distance(p, a, m) > kBand2) ||
            (k >= middle && squared_distance(p, m, d) > kBand2))
            return false;
    }
    return true;
}

// What is gained lies within the band of the chain, other edges within that of their own. Points of an
// boundary are at most sqrt(2) apart, so something that touches has points nearer than 2 (1 + 0.71), which
// along either axis is 3 whole pixels. (Strips, whose points are not at pixel centres, are straight and
// stay.)
bool MaskBoundary::collides(const RingMesh& rings, const Sides& s, const Vec2f& m) {
    constexpr int kReach = 3;
    const auto at = [&](Id v) { return Vec2f(rings[v].x, rings[v].y); };
    std::array<std::array<Vec2f, 3>, 3> gained = gains(at(s.a), at(s.b), at(s.c), at(s.d), m);
    const auto end = std::remove_if(gained.begin(), gained.end(),
                                    [](const auto& t) { return turn(t[0], t[1], t[2]) == 0; });
    if (end == gained.begin()) return false;
    const Id own[] = {point_[s.a], point_[s.b], point_[s.c]};
    ++searches_;
    const auto touches = [&](Id first_point) {
        const Id owner = points_[first_point].owner;
        if (points_[owner].looked_at == searches_) return false;
        points_[owner].looked_at = searches_;
        if (std::find(std::begin(own), std::end(own), owner) != std::end(own)) return false;
        const Id v = points_[owner].vertex;
        const Vec2f p = at(v), q = at(rings[v].neighbor[0]);
        return std::any_of(gained.begin(), end, [&](const auto& t) { return enters(p, q, t); });
    };
    const int w = grid_.feature.width, h = grid_.feature.height;
    const auto pixels = static_cast<Id>(grid_.feature.pixel_count());
    for (const Id n : chain_) {
        const int px = static_cast<int>(points_[n].pixel) % w, py = static_cast<int>(points_[n].pixel) / w;
        for (int y = std::max(0, py - kReach); y <= std::min(h - 1, py + kReach); ++y)
            for (int x = std::max(0, px - kReach); x <= std::min(w - 1, px + kReach); ++x) {
                const auto pixel = static_cast<Id>(y * w + x);
                if (first_point_[pixel] != kNone && touches(first_point_[pixel])) return true;
                auto copy = std::lower_bound(grid_.copies.begin(), grid_.copies.end(), pixel);
                for (; copy != grid_.copies.end() && *copy == pixel; ++copy) {
                    const Id v = pixels + static_cast<Id>(copy - grid_.copies.begin());
                    if (first_point_[v] != kNone && touches(first_point_[v])) return true;
                }
            }
    }
    return false;
}

bool MaskBoundary::allows(const RingMesh& rings, Id i, Id j, float x, float y) {
    const Sides s = sides(rings, i, j);
    const Vec2f m(x, y), b(rings[s.b].x, rings[s.b].y), c(rings[s.c].x, rings[s.c].y);
    const bool in_image = x >= 0 && y >= 0 && x <= static_cast<float>(grid_.feature.width - 1) &&
                          y <= static_cast<float>(grid_.feature.height - 1);
    if (!in_image && m != b && m != c) return false;  // the ends of strips may be outside already
    collect_chain(s);
    return within_band(rings, s, m) && !collides(rings, s, m);
}

void MaskBoundary::merge(const RingMesh& rings, Id i, Id j, float x, float y) {
    if (rings[i].border() && rings[j].border()) {
        const Sides s = sides(rings, i, j);
        collect_chain(s);
        const std::size_t middle = nearest_in_chain(x, y);
        const Id first = point_[s.a], merged = point_[i];
        for (std::size_t k = 0; k + 1 < chain_.size(); ++k)
            points_[chain_[k]].owner = k < middle ? first : merged;
        points_[merged].anchor = chain_[middle];
    } else if (rings[j].border()) {
        point_[i] = point_[j];
        points_[point_[i]].vertex = i;
    }
    point_[j] = kNone;
}

}  // namespace imgmesh
