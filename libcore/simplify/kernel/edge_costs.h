// Where the vertex that replaces an edge goes, and what that costs.
#pragma once

#include <algorithm>
#include <type_traits>
#include <utility>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/simplify/kernel/border_rules.h"
#include "libcore/simplify/kernel/collapse_stats.h"
#include "libcore/simplify/kernel/merge_increments.h"
#include "libcore/simplify/kernel/quadric_mesh.h"

namespace imgmesh {

/// A place for a merged vertex.
struct Placement {
    float x = 0, y = 0;
    float cost = kNever;  ///< the edge is filed by it; kNever where the merge is not allowed
};

/// The costs of the edges of a mesh, as it stands at each call. `Q` is the quadric that vertices carry:
/// merged(a, b), at(x, y), features(x, y, out), error, the minimiser (px, py) and best_x(y), best_y(x) on a
/// line where has_minimum(fixed). initial_quadrics and rebuilt_quadrics make vectors of it.
template <class Q, class Rings = RingMesh>
class EdgeCosts {
  public:
    EdgeCosts(const QuadricMesh<Q>& mesh, const SimplifyRules& rules)
        : EdgeCosts(mesh.rings, mesh.quadrics, rules) {}
    EdgeCosts(const Rings& rings, const std::vector<Q>& quadrics, const SimplifyRules& rules)
        : rings_(rings), quadrics_(quadrics), rules_(rules) {}

    /// What filing an edge of two vertices would cost; kNever where it may not merge.
    float cost(Id i, Id j) const { return best_place(i, j, merged(quadrics_[i], quadrics_[j])).cost; }
    /// For all edges of a vertex at once: what the least error grows by. Both arrays have kNeighborRoom
    /// places, of which those behind `count` are overwritten. Does nothing for quadrics that may have no
    /// minimum.
    template <class Number>
    void increments(Number i, Number* others, int count, float* out) const {
        if constexpr (kCanonical<Q>) merge_increments(quadrics_.data(), i, others, count, out);
    }
    /// cost(i, j) from its increment. That is all it takes away from the border.
    float cost(Id i, Id j, float increment) const {
        const bool inside = kCanonical<Q> && !rings_[i].border() && !rings_[j].border();
        return inside ? priority(i, j, increment) : cost(i, j);
    }

    /// Where the merged vertex, of the quadric `sum`, goes at best. The triangles around it are not looked
    /// at.
    Placement best_place(Id i, Id j, const Q& sum) const {
        if (along_boundary(i, j)) return boundary_place(i, j, sum, [](const Placement&) { return true; });
        const BorderConstraint border = constraint(i, j);
        if (!border.allowed) return {};
        if (!sum.has_minimum(border.fixed))
            return cheapest_of_three(i, j, sum, border, [](const Placement&) { return true; });
        Placement place{border.x, border.y};
        // On a side the position is free along one axis only.
        if (border.fixed == 0) {
            place.x = snapped(sum.px);
            place.y = snapped(sum.py);
        } else if (border.fixed == kFixedX) {
            place.y = snapped(sum.best_y(place.x));
        } else if (border.fixed == kFixedY) {
            place.x = snapped(sum.best_x(place.y));
        }
        place.cost = cost_at(i, j, sum, place);
        return place;
    }

    /// Whether the merged vertex, with the ring `ring`, may stand at a place: no triangle around it is of a
    /// forbidden shape, and the boundary of a masked image allows it.
    template <class Merged>
    bool allowed(Id i, Id j, const Merged& ring, const Placement& place) const {
        const bool border = rings_[i].border() || rings_[j].border();
        if (!rules_.limits.allow(rings_, ring, border, place.x, place.y)) return false;
        if constexpr (kWhole)
            return !along_boundary(i, j) || rules_.boundary->allows(rings_, i, j, place.x, place.y);
        return true;
    }

    /// Whether their merge takes away a vertex of a side that must go. Such a merge is due, whatever it
    /// costs.
    bool is_due(Id i, Id j) const {
        return rules_.sides_decided && (must_go(rings_[i]) || must_go(rings_[j]));
    }

    /// Where it goes when the best place is not allowed: the cheapest allowed one of midpoint and ends, or of
    /// the boundary's places.
    template <class Merged>
    Placement fallback(Id i, Id j, const Merged& ring, const Q& sum) const {
        const auto legal = [&](const Placement& p) { return allowed(i, j, ring, p); };
        if (along_boundary(i, j)) return boundary_place(i, j, sum, legal);
        const BorderConstraint border = constraint(i, j);
        return border.allowed ? cheapest_of_three(i, j, sum, border, legal) : Placement{};
    }

  private:
    // Whether both ends are on a boundary of a masked image, which decides. The edge may lie on it or cross
    // the inside.
    bool along_boundary(Id i, Id j) const {
        return kWhole && rules_.boundary && rings_[i].border() && rings_[j].border() && !is_due(i, j);
    }

    BorderConstraint constraint(Id i, Id j) const {
        // What an inner vertex stands for would wait on the side until the last of its vertices goes.
        if (is_due(i, j) && !(rings_[i].border() && rings_[j].border())) return {};
        return border_constraint(rings_[i], rings_[j]);
    }

    bool on_side(Id v) const { return rules_.boundary->on_side({rings_[v].x, rings_[v].y}); }

    // The cheapest of the places that the boundary has for the merged vertex, of those allowed.
    template <class Allowed>
    Placement boundary_place(Id i, Id j, const Q& sum, const Allowed& allowed) const {
        Placement best;
        if constexpr (kWhole) {
            if (rings_[i].neighbor[0] != j && rings_[j].neighbor[0] != i) return best;
            if (rules_.sides_decided && (on_side(i) || on_side(j))) return best;
            const MaskBoundary::Places places = rules_.boundary->places(rings_, i, j, sum.px, sum.py);
            for (int k = 0; k < places.count; ++k) {
                const Vec2f& at = places.at[static_cast<std::size_t>(k)];
                if (rules_.sides_decided && rules_.boundary->on_side(at)) continue;  // no new vertex there
                Placement p{at.x(), at.y(), 0};
                p.cost = cost_at(i, j, sum, p);
                if (p.cost < best.cost && allowed(p)) best = p;
            }
        }
        return best;
    }

    template <class Allowed>
    Placement cheapest_of_three(Id i, Id j, const Q& sum, const BorderConstraint& border,
                                const Allowed& allowed) const {
        const auto &a = rings_[i], &b = rings_[j];
        Placement best;
        const std::pair<float, float> candidates[] = {
            {0.5f * (a.x + b.x), 0.5f * (a.y + b.y)}, {a.x, a.y}, {b.x, b.y}};
        for (const auto& [cx, cy] : candidates) {
            Placement p{border.fixed & kFixedX ? border.x : snapped(cx),
                        border.fixed & kFixedY ? border.y : snapped(cy), 0};
            p.cost = cost_at(i, j, sum, p);
            if (p.cost < best.cost && allowed(p)) best = p;
        }
        return best;
    }

    float cost_at(Id i, Id j, const Q& sum, const Placement& place) const {
        const float cost = priority(i, j, sum.at(place.x, place.y) - quadrics_[i].error - quadrics_[j].error);
        return is_due(i, j) ? kDue * cost : cost;
    }
    // What an edge is filed by, from what its merge adds to the error.
    float priority(Id i, Id j, float added) const {
        added = std::max(0.0f, added);
        return rules_.params.total_priority ? added + (quadrics_[i].error + quadrics_[j].error) : added;
    }

    // Of merges that are due: they come before all others of their surroundings.
    static constexpr float kDue = 1e-4f;
    static constexpr bool kWhole = std::is_same_v<Rings, RingMesh>;

    const Rings& rings_;
    const std::vector<Q>& quadrics_;
    const SimplifyRules& rules_;
};

/// The middle one in order of size, of an even number the upper one; there must be one.
inline float median(std::vector<float> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

}  // namespace imgmesh
