// The inner loop of simplify: which edges of a mesh may merge, where to, and the queue that says which is
// next. It works on a whole mesh, or on one tile of it beside others that work on theirs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "libcore/image/channel_count.h"
#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/kernel/border_rules.h"
#include "libcore/simplify/kernel/bucket_queue.h"
#include "libcore/simplify/kernel/mask_boundary.h"
#include "libcore/simplify/kernel/merge_increments.h"
#include "libcore/simplify/kernel/shape_limits.h"
#include "libcore/simplify/quadrics/quadric_sources.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

inline constexpr float kNever = std::numeric_limits<float>::infinity();

/// A mesh with what its vertices carry.
template <class Q>
struct QuadricMesh {
    RingMesh rings;
    std::vector<Q> quadrics;
    std::vector<Id> pixel;  ///< the number in the grid mesh of each vertex; empty where it is the same
};

/// What has been collapsed, or may be.
struct CollapseStats {
    std::int64_t vertices = 0, faces = 0;  ///< taken away
    double error = 0;                      ///< largest total quadric error of a merged vertex
    float postponed = kNever;              ///< least cost of the edges that are beyond the threshold

    void add(const CollapseStats& other) {
        vertices += other.vertices;
        faces += other.faces;
        error = std::max(error, other.error);
        postponed = std::min(postponed, other.postponed);
    }
};

inline constexpr CollapseStats kAllMayGo{.vertices = std::numeric_limits<std::int64_t>::max(),
                                         .faces = std::numeric_limits<std::int64_t>::max()};

/// What holds for every collapse of a run.
struct SimplifyRules {
    const SimplifyParams& params;
    const SimplifyHooks& hooks;
    int channels;  ///< of the quadrics
    ShapeLimits limits;
    MaskBoundary* boundary = nullptr;  ///< of a masked image
    double max_error = std::numeric_limits<double>::infinity();
};

/// Source and steps: simplify.cpp. `Q` is the quadric that vertices carry: merged(a, b), at(x, y),
/// features(x, y, out), error, the minimiser (px, py) and best_x(y), best_y(x) on a
/// line where has_minimum(fixed); initial_quadrics and rebuilt_quadrics make vectors of it.
///
/// Edges with a locked end (Ring::locked) are left alone. So several collapsers may work on one mesh at the
/// same time where each has its own vertices, and those with a neighbour of another collapser are locked.
template <class Q>
class EdgeCollapser {
  public:
    EdgeCollapser(QuadricMesh<Q>& mesh, const SimplifyRules& rules)
        : rings_(mesh.rings), quadrics_(mesh.quadrics), rules_(rules) {}

    /// Collapses the edges of the vertices [0, count) that vertex(n) gives, the cheapest first, until none is
    /// left below `threshold` or as many vertices or faces are removed as may go. Each edge counts for its
    /// end of the lower number, or with `from_either_end` for either.
    template <class Vertex>
    CollapseStats run(std::size_t count, const Vertex& vertex, float threshold, const CollapseStats& may_go,
                      bool from_either_end = false) {
        threshold_ = threshold;
        may_go_ = may_go;
        stats_ = {};
        for (std::size_t n = 0; n < count; ++n)
            if (const Id i = vertex(n); rings_[i].live() && !rings_[i].locked)
                file_edges_of(i, from_either_end ? 0 : i);
        drain();
        queue_.clear();
        return stats_;
    }

    /// What filing an edge of two vertices would cost; kNever where it may not merge.
    float cost(Id i, Id j) const { return minimiser(i, j, merged(quadrics_[i], quadrics_[j])).cost; }

  private:
    struct Placement {
        float x = 0, y = 0;
        float cost = kNever;  // by which the edge is filed; kNever where the merge is not allowed
    };

    // Collapses until the queue is empty or a limit is reached. Memory is what takes the time: an edge is
    // handed out a few steps ahead of its turn, and what it will touch is fetched meanwhile.
    void drain() {
        constexpr std::size_t kAhead = 8;
        struct Waiting {
            QueuedEdge edge;
            int bucket;
        };
        std::array<Waiting, kAhead> waiting;
        std::size_t taken = 0, tried = 0;
        while (!done() && (tried < taken || !queue_.empty())) {
            if (!queue_.empty()) {
                const int bucket = queue_.lowest_bucket();
                waiting[taken % kAhead] = {queue_.pop(), bucket};
                prefetch_ends(waiting[taken % kAhead].edge);
                if (++taken >= kAhead / 2) prefetch_rings(waiting[(taken - kAhead / 2) % kAhead].edge);
                if (taken - tried < kAhead) continue;
            }
            const Waiting& next = waiting[tried++ % kAhead];
            try_collapse(next.edge, next.bucket);
        }
    }

    void prefetch_ends(const QueuedEdge& edge) const {
        __builtin_prefetch(&rings_[edge.i]);
        __builtin_prefetch(&rings_[edge.j]);
        __builtin_prefetch(&quadrics_[edge.i]);
        __builtin_prefetch(&quadrics_[edge.j]);
    }
    void prefetch_rings(const QueuedEdge& edge) const {
        if (!current(edge)) return;
        for (const Id v : {edge.i, edge.j})
            for (int k = 0; k < rings_[v].valence; ++k) {
                __builtin_prefetch(&rings_[rings_[v].neighbor[k]]);
                __builtin_prefetch(&quadrics_[rings_[v].neighbor[k]]);
            }
    }
    bool current(const QueuedEdge& edge) const {
        return rings_[edge.i].version == edge.version_i && rings_[edge.j].version == edge.version_j;
    }

    bool done() const { return stats_.vertices >= may_go_.vertices || stats_.faces >= may_go_.faces; }

    // Where the merged vertex goes at best, and what that costs; legality of the star left aside.
    Placement minimiser(Id i, Id j, const Q& sum) const {
        if (along_boundary(i, j)) return boundary_place(i, j, sum, [](const Placement&) { return true; });
        const BorderConstraint border = border_constraint(rings_[i], rings_[j]);
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

    // Whether an edge joins two vertices on a boundary of a masked image, be it along it or through the
    // inside.
    bool along_boundary(Id i, Id j) const {
        return rules_.boundary && rings_[i].border() && rings_[j].border();
    }

    // The cheapest of the places that the boundary has for the merged vertex, of those allowed.
    template <class Allowed>
    Placement boundary_place(Id i, Id j, const Q& sum, const Allowed& allowed) const {
        Placement best;
        if (rings_[i].neighbor[0] != j && rings_[j].neighbor[0] != i) return best;
        const MaskBoundary::Places places = rules_.boundary->places(rings_, i, j, sum.px, sum.py);
        for (int k = 0; k < places.count; ++k) {
            const Vec2f& at = places.at[static_cast<std::size_t>(k)];
            Placement p{at.x(), at.y(), 0};
            p.cost = cost_at(i, j, sum, p);
            if (p.cost < best.cost && allowed(p)) best = p;
        }
        return best;
    }

    // Whether the merge of i and j, with the ring `ring`, may stand at a place.
    bool allowed(Id i, Id j, const MergedRing& ring, const Placement& place) {
        const bool border = rings_[i].border() || rings_[j].border();
        return rules_.limits.allow(rings_, ring, border, place.x, place.y) &&
               (!along_boundary(i, j) || rules_.boundary->allows(rings_, i, j, place.x, place.y));
    }

    float cost_at(Id i, Id j, const Q& sum, const Placement& place) const {
        return priority(i, j, sum.at(place.x, place.y) - quadrics_[i].error - quadrics_[j].error);
    }

    // What an edge is filed by, from what its merge adds to the error.
    float priority(Id i, Id j, float added) const {
        added = std::max(0.0f, added);
        return rules_.params.total_priority ? added + (quadrics_[i].error + quadrics_[j].error) : added;
    }

    // The cheapest legal one of midpoint and ends, or of the boundary's places.
    Placement fallback(Id i, Id j, const MergedRing& ring, const Q& sum) {
        const auto legal = [&](const Placement& p) { return allowed(i, j, ring, p); };
        if (along_boundary(i, j)) return boundary_place(i, j, sum, legal);
        const BorderConstraint border = border_constraint(rings_[i], rings_[j]);
        return border.allowed ? cheapest_of_three(i, j, sum, border, legal) : Placement{};
    }

    template <class Allowed>
    Placement cheapest_of_three(Id i, Id j, const Q& sum, const BorderConstraint& border,
                                const Allowed& allowed) const {
        const Ring &a = rings_[i], &b = rings_[j];
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

    void try_collapse(const QueuedEdge& edge, int bucket) {
        if (!current(edge)) return;
        const Id i = edge.i, j = edge.j;
        MergedRing ring;
        if (!merge_rings(rings_, i, j, ring)) return;
        const Q sum = merged(quadrics_[i], quadrics_[j]);
        Placement place = minimiser(i, j, sum);
        if (!allowed(i, j, ring, place)) {
            place = fallback(i, j, ring, sum);
            if (place.cost == kNever) return;
            if (BucketQueue::bucket_of(place.cost) > bucket) {
                if (place.cost < threshold_)
                    queue_.push(place.cost, edge);
                else
                    stats_.postponed = std::min(stats_.postponed, place.cost);
                return;
            }
        }
        const float total = sum.at(place.x, place.y);
        if (total > rules_.max_error) return;
        if (rules_.hooks.before && !may_happen(i, j, sum, place)) return;
        stats_.error = std::max(stats_.error, static_cast<double>(total));
        if (rules_.boundary) rules_.boundary->merge(rings_, i, j, place.x, place.y);
        apply_merge(rings_, i, j, ring);
        rings_[i].x = place.x;
        rings_[i].y = place.y;
        quadrics_[i] = sum;
        ++stats_.vertices;
        stats_.faces += ring.faces_removed;
        file_edges_of(i, 0);
    }

    // What the follower says to a collapse.
    bool may_happen(Id i, Id j, const Q& sum, const Placement& place) const {
        std::array<float, kMaxFeatures> feature;
        sum.features(place.x, place.y, feature.data());
        return rules_.hooks.before(
            {i, j, place.x, place.y, std::span(feature).first(static_cast<std::size_t>(rules_.channels))});
    }

    // Files the edges of vertex i that cost less than the threshold, but for those to vertices below `from`.
    void file_edges_of(Id i, Id from) {
        const Ring& ring = rings_[i];
        Id others[kNeighborRoom];
        float costs[kNeighborRoom];
        int count = 0;
        for (int k = 0; k < ring.valence; ++k) {
            const Id j = others[count] = ring.neighbor[k];
            count += j >= from && !rings_[j].locked;
        }
        if constexpr (kBatched) merge_increments(quadrics_.data(), i, others, count, costs);
        for (int k = 0; k < count; ++k) {
            const Id j = others[k];
            const bool batched = kBatched && !ring.border() && !rings_[j].border();
            const float cost_k = batched ? priority(i, j, costs[k]) : cost(i, j);
            if (cost_k < threshold_)
                queue_.push(cost_k, {i, j, ring.version, rings_[j].version});
            else
                stats_.postponed = std::min(stats_.postponed, cost_k);
        }
    }

    // Of a quadric that may have no minimiser the edge's midpoint and ends have to be tried.
    static constexpr bool kBatched = kCanonical<Q>;

    RingMesh& rings_;
    std::vector<Q>& quadrics_;
    const SimplifyRules& rules_;
    BucketQueue queue_;
    float threshold_ = 0;
    CollapseStats stats_, may_go_;
};

}  // namespace imgmesh
