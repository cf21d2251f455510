// Sources: Eberly, "Triangulation by ear clipping" (2002); Lawson's flips (1977).
#include "libcore/mesh/triangulate.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/mesh/loop_parts.h"

namespace imgmesh {
namespace {

using Ring = std::vector<Id>;

class Triangulation {
  public:
    explicit Triangulation(const std::vector<Loop>& loops) {
        for (const Loop& loop : loops) {
            Ring& ring = rings_.emplace_back();
            for (const Vec2d& p : loop) {
                ring.push_back(as_id(mesh_.position.size()));
                mesh_.position.push_back(p.cast<float>());
            }
        }
        mesh_.channels = 0;
    }

    BaseMesh run(const std::vector<Loop>& loops) {
        for (const std::vector<std::size_t>& loops_of_part : loop_parts(loops)) {
            std::vector<Ring> part;  // an outer ring and its holes
            for (const std::size_t i : loops_of_part) part.push_back(rings_[i]);
            clip_ears(joined(part));
        }
        flip();
        return std::move(mesh_);
    }

  private:
    const Vec2f& at(Id v) const { return mesh_.position[v]; }
    double left(Id a, Id b, Id c) const { return signed_area2(at(a), at(b), at(c)); }

    // Whether the inner parts of a b and c d cross, or an end of one lies inside the other.
    bool cross(Id a, Id b, Id c, Id d) const {
        const double ac = left(a, b, c), ad = left(a, b, d), ca = left(c, d, a), cb = left(c, d, b);
        if (((ac > 0 && ad < 0) || (ac < 0 && ad > 0)) && ((ca > 0 && cb < 0) || (ca < 0 && cb > 0)))
            return true;
        return (ac == 0 && between(a, b, c)) || (ad == 0 && between(a, b, d)) ||
               (ca == 0 && between(c, d, a)) || (cb == 0 && between(c, d, b));
    }
    // p on the line a b: whether it is strictly between.
    bool between(Id a, Id b, Id p) const {
        const Vec2f along = at(b) - at(a), to = at(p) - at(a);
        return to.dot(along) > 0 && to.dot(along) < along.squaredNorm();
    }

    // Whether the inside at corner i of a ring contains the direction to v.
    bool opens_to(const Ring& ring, std::size_t i, Id v) const {
        const Id a = ring[(i + ring.size() - 1) % ring.size()], b = ring[i], c = ring[(i + 1) % ring.size()];
        if (left(a, b, c) > 0) return left(a, b, v) > 0 && left(b, c, v) > 0;
        return left(a, b, v) > 0 || left(b, c, v) > 0;
    }

    // Joins the holes to the outer ring by bridges, which run both ways. From the rightmost corner of the
    // rightmost hole some corner of the ring can be seen.
    Ring joined(std::vector<Ring>& part) const {
        Ring ring = part[0];
        std::vector<Ring> holes(part.begin() + 1, part.end());
        const auto right = [&](const Ring& hole) {
            return std::max_element(hole.begin(), hole.end(),
                                    [&](Id a, Id b) { return at(a).x() < at(b).x(); }) -
                   hole.begin();
        };
        std::sort(holes.begin(), holes.end(), [&](const Ring& a, const Ring& b) {
            return at(a[static_cast<std::size_t>(right(a))]).x() >
                   at(b[static_cast<std::size_t>(right(b))]).x();
        });
        for (std::size_t h = 0; h < holes.size(); ++h) {
            Ring& hole = holes[h];
            std::rotate(hole.begin(), hole.begin() + right(hole), hole.end());
            std::vector<std::pair<float, std::size_t>> order;
            for (std::size_t i = 0; i < ring.size(); ++i)
                order.emplace_back((at(ring[i]) - at(hole[0])).squaredNorm(), i);
            std::sort(order.begin(), order.end());
            const auto free = [&](std::size_t i) {
                if (order[i].first == 0) return opens_to(ring, order[i].second, hole[1]);
                const Id v = ring[order[i].second];
                if (!opens_to(ring, order[i].second, hole[0]) || !opens_to(hole, 0, v)) return false;
                const auto meets = [&](const Ring& other) {
                    for (std::size_t k = 0; k < other.size(); ++k)
                        if (cross(hole[0], v, other[k], other[(k + 1) % other.size()])) return true;
                    return false;
                };
                return !meets(ring) &&
                       std::none_of(holes.begin() + static_cast<std::ptrdiff_t>(h), holes.end(), meets);
            };
            std::size_t i = 0;
            while (i < order.size() && !free(i)) ++i;
            if (i == order.size())
                throw Error(ErrorKind::kInternal, "no bridge leads to a hole of an outline");
            const auto place = ring.begin() + static_cast<std::ptrdiff_t>(order[i].second);
            Ring bridge = {*place};
            bridge.insert(bridge.end(), hole.begin(), hole.end());
            bridge.push_back(hole[0]);
            ring.insert(place, bridge.begin(), bridge.end());
        }
        return ring;
    }

    void clip_ears(Ring ring) {
        std::size_t i = 0, since = 0;
        while (ring.size() > 3) {
            const std::size_t n = ring.size();
            i %= n;
            const Id a = ring[(i + n - 1) % n], b = ring[i], c = ring[(i + 1) % n];
            if (is_ear(ring, a, b, c)) {
                mesh_.faces.push_back({a, b, c});
                ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
                since = 0;
            } else if (++since > n) {
                throw Error(ErrorKind::kInternal, "an outline crosses itself");
            } else {
                ++i;
            }
        }
        if (left(ring[0], ring[1], ring[2]) > 0) mesh_.faces.push_back({ring[0], ring[1], ring[2]});
    }

    bool is_ear(const Ring& ring, Id a, Id b, Id c) const {
        if (!(left(a, b, c) > 0)) return false;
        for (const Id v : ring) {
            if (at(v) == at(a) || at(v) == at(b) || at(v) == at(c)) continue;
            if (left(a, b, v) >= 0 && left(b, c, v) >= 0 && left(c, a, v) >= 0) return false;
        }
        return true;
    }

    // Flips inner edges until each is locally Delaunay.
    void flip() {
        for (std::size_t pass = 0; pass < mesh_.faces.size(); ++pass)
            if (!flip_once()) return;
    }
    bool flip_once() {
        std::map<std::pair<Id, Id>, std::pair<std::size_t, std::size_t>> corner;  // of directed edges
        for (std::size_t f = 0; f < mesh_.faces.size(); ++f)
            for (std::size_t i = 0; i < 3; ++i)
                corner[{mesh_.faces[f][i], mesh_.faces[f][(i + 1) % 3]}] = {f, i};
        std::vector<std::uint8_t> touched(mesh_.faces.size(), 0);
        bool any = false;
        for (const auto& [edge, own] : corner) {
            const auto other = corner.find({edge.second, edge.first});
            if (edge.first > edge.second || other == corner.end()) continue;
            const auto [f, i] = own;
            const auto [g, j] = other->second;
            if (touched[f] || touched[g]) continue;
            const Id a = edge.first, b = edge.second, c = mesh_.faces[f][(i + 2) % 3],
                     d = mesh_.faces[g][(j + 2) % 3];
            if (!(left(a, d, c) > 0) || !(left(d, b, c) > 0) || !in_circle(a, b, c, d)) continue;
            mesh_.faces[f] = {a, d, c};
            mesh_.faces[g] = {d, b, c};
            touched[f] = touched[g] = 1;
            any = true;
        }
        return any;
    }

    // Whether d lies in the circle around the face a b c, by more than rounding.
    bool in_circle(Id a, Id b, Id c, Id d) const {
        const auto cosine = [&](Id from, Id p, Id q) {
            const Vec2d u = (at(p) - at(from)).cast<double>(), v = (at(q) - at(from)).cast<double>();
            return std::pair(u.dot(v), std::abs(u.x() * v.y() - u.y() * v.x()));
        };
        // The angles at c and d sum to more than 180 degrees: the sine of the sum is negative.
        const auto [cos_c, sin_c] = cosine(c, a, b);
        const auto [cos_d, sin_d] = cosine(d, a, b);
        return sin_c * cos_d + cos_c * sin_d < -1e-9 * (sin_c + std::abs(cos_c)) * (sin_d + std::abs(cos_d));
    }

    std::vector<Ring> rings_;
    BaseMesh mesh_;
};

}  // namespace

BaseMesh triangulated(const std::vector<Loop>& loops) {
    return Triangulation(loops).run(loops);
}

}  // namespace imgmesh
