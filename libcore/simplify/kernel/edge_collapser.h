// The inner loop of simplify: edges collapse in the order of their costs until there is nothing left to do.
// It works on a whole mesh; tile_collapser.h does while the goal is far.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "libcore/image/channel_count.h"
#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/kernel/bucket_queue.h"
#include "libcore/simplify/kernel/collapse_stats.h"
#include "libcore/simplify/kernel/edge_costs.h"
#include "libcore/simplify/kernel/quadric_mesh.h"

namespace imgmesh {

/// Sources and steps: simplify.cpp. `Q` is the quadric that vertices carry (edge_costs.h).
template <class Q>
class EdgeCollapser {
  public:
    EdgeCollapser(QuadricMesh<Q>& mesh, const SimplifyRules& rules)
        : rings_(mesh.rings), quadrics_(mesh.quadrics), rules_(rules), costs_(mesh, rules) {}

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
            if (const Id i = vertex(n); rings_[i].live()) file_edges_of(i, from_either_end ? 0 : i);
        drain();
        queue_.clear();
        return stats_;
    }

  private:
    // Collapses until the queue is empty or a limit is reached. Most of the time goes into waiting for
    // memory. So an edge is taken from the queue a few steps ahead of its turn, and what it will touch is
    // fetched meanwhile. Recheck kAhead by the time of `imgmesh-build --preset fast` on an image of 2048 x
    // 2048.
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

    bool done() const { return stats_.reached(may_go_); }

    void try_collapse(const QueuedEdge& edge, int bucket) {
        if (!current(edge)) return;
        const Id i = edge.i, j = edge.j;
        MergedRing ring;
        if (!merge_rings(rings_, i, j, ring)) return;
        const Q sum = merged(quadrics_[i], quadrics_[j]);
        Placement place = costs_.best_place(i, j, sum);
        if (!costs_.allowed(i, j, ring, place)) {
            place = costs_.fallback(i, j, ring, sum);
            if (place.cost == kNever) return;
            if (BucketQueue::bucket_of(place.cost) > bucket) {
                if (place.cost < threshold_)
                    queue_.push(place.cost, edge);
                else
                    stats_.postponed = std::min(stats_.postponed, place.cost);
                return;
            }
        }
        if (costs_.is_due(i, j)) {
            ++stats_.due;
        } else {
            const float total = sum.at(place.x, place.y);
            if (total > rules_.max_error || place.cost > rules_.max_increment) return;
            if (rules_.hooks.before && !may_happen(i, j, sum, place)) return;
            stats_.error = std::max(stats_.error, static_cast<double>(total));
            stats_.increment = std::max(stats_.increment, place.cost);
            ++stats_.vertices;
            stats_.faces += ring.faces_removed;
            if (rules_.hooks.after)
                rules_.hooks.after({{{rings_[i].x, rings_[i].y}, {rings_[j].x, rings_[j].y}},
                                    {place.x, place.y},
                                    place.cost});
        }
        if (rules_.boundary) rules_.boundary->merge(rings_, i, j, place.x, place.y);
        apply_merge(rings_, i, j, ring);
        rings_[i].x = place.x;
        rings_[i].y = place.y;
        quadrics_[i] = sum;
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
        float increments[kNeighborRoom];
        int count = 0;
        for (int k = 0; k < ring.valence; ++k) {
            const Id j = others[count] = ring.neighbor[k];
            count += j >= from;
        }
        costs_.increments(i, others, count, increments);
        for (int k = 0; k < count; ++k) {
            const Id j = others[k];
            const float cost = costs_.cost(i, j, increments[k]);
            if (cost < threshold_)
                queue_.push(cost, {i, j, ring.version, rings_[j].version});
            else
                stats_.postponed = std::min(stats_.postponed, cost);
        }
    }

    RingMesh& rings_;
    std::vector<Q>& quadrics_;
    const SimplifyRules& rules_;
    EdgeCosts<Q> costs_;
    BucketQueue queue_;
    float threshold_ = 0;
    CollapseStats stats_, may_go_;
};

}  // namespace imgmesh
