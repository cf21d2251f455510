// The engine of collapse_edges: rings, quadrics and the queue, and the rules of what may merge.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "libcore/collapse/border_rules.h"
#include "libcore/collapse/bucket_queue.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/collapse/edge_batch.h"
#include "libcore/collapse/mask_outline.h"
#include "libcore/collapse/quadric_sources.h"
#include "libcore/collapse/ring_mesh.h"
#include "libcore/collapse/star_limits.h"

namespace imgmesh {

inline constexpr float kNever = std::numeric_limits<float>::infinity();

// The queue holds only edges cheaper than a threshold, which rises by this factor when they are used up.
// Larger wastes memory, smaller scans the mesh more often.
inline constexpr float kWindow = 4.0f;

// While the goal is far, a window is worked off tile by tile, so that what is touched stays in the cache. The
// order differs from the exact one by at most a window, which does not show in the result as long as no
// window ends early.
inline constexpr int kTile = 64;
inline constexpr std::int64_t kTiledAbove = 4;

struct Placement {
    float x = 0, y = 0;
    float cost = kNever;  // by which the edge is filed; kNever where the merge is not allowed
};

/// Source and steps: collapse_edges.cpp. `Q` is the quadric that vertices carry: kChannels features,
/// merged(a, b), at(x, y), feature(c, x, y), error, the minimiser (px, py) and best_x(y), best_y(x) on a
/// line where has_minimum(fixed); initial_quadrics and rebuilt_quadrics make vectors of it.
template <class Q>
class Collapser {
  public:
    Collapser(const GridMesh& grid, const CollapseParams& params, const CollapseHooks& hooks)
        : params_(params),
          hooks_(hooks),
          width_(grid.feature.width),
          height_(grid.feature.height),
          rings_(ring_mesh(grid)),
          quadrics_(initial_quadrics<Q>(grid, rings_, params)),
          limits_(StarLimits::of(params.max_face_area, params.min_shape)),
          dense_vertices_(live_vertices(rings_)),
          vertices_(dense_vertices_),
          next_rebuild_(vertices_ / 2),
          faces_(face_count(rings_)) {
        if (!grid.mask.empty()) outline_.emplace(grid, rings_);
    }

    void run(const CollapseTarget& target, const Progress& progress) {
        target_ = target;
        target_.faces = std::max(target.faces,
                                 static_cast<std::int64_t>(target.face_share * static_cast<double>(faces_)));
        if (threshold_ == 0) threshold_ = first_threshold();
        while (!done()) {
            if (params_.rebuild_quadrics && vertices_ <= next_rebuild_) rebuild_quadrics();
            const std::int64_t collapses_before = collapses_;
            postponed_ = kNever;
            const int side = params_.tiles && far_from_done() ? kTile : std::max(width_, height_);
            for (int y = 0; y < height_ && !done(); y += side)
                for (int x = 0; x < width_ && !done(); x += side) {
                    file_tile(x, y, side);
                    drain();
                }
            if (progress) progress(fraction_done(), "collapse");
            if (done() || (collapses_ == collapses_before && postponed_ == kNever)) break;
            // Where nothing has changed, windows below the cheapest edge would stay empty: a flat picture's
            // first window is far below what the rest costs.
            do threshold_ *= kWindow;
            while (collapses_ == collapses_before && threshold_ <= postponed_);
        }
        queue_ = {};
    }

    CollapseResult snapshot() const {
        CollapseResult result{{}, error_, collapses_};
        std::vector<Id> live;
        result.mesh.channels = Q::kChannels;
        result.mesh.faces = ring_faces(rings_, live);
        for (const Id v : live) {
            const Ring& ring = rings_[v];
            result.mesh.position.emplace_back(ring.x, ring.y);
            for (int c = 0; c < Q::kChannels; ++c)
                result.mesh.feature.push_back(quadrics_[v].feature(c, ring.x, ring.y));
        }
        return result;
    }

  private:
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

    bool done() const { return vertices_ <= target_.vertices || faces_ <= target_.faces; }
    double fraction_done() const {
        const auto start = static_cast<double>(dense_vertices_), left = static_cast<double>(vertices_);
        return (start - left) / std::max(1.0, start - static_cast<double>(target_.vertices));
    }

    // Where the merged vertex goes at best, and what that costs; legality of the star left aside.
    Placement minimiser(Id i, Id j, const Q& sum) const {
        if (along_outline(i, j)) return outline_place(i, j, sum, [](const Placement&) { return true; });
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

    // Whether an edge joins two vertices on an outline of a cut-out, be it along it or through the inside.
    bool along_outline(Id i, Id j) const { return outline_ && rings_[i].border() && rings_[j].border(); }

    // The cheapest of the places that the outline has for the merged vertex, of those allowed.
    template <class Allowed>
    Placement outline_place(Id i, Id j, const Q& sum, const Allowed& allowed) const {
        Placement best;
        if (rings_[i].neighbor[0] != j && rings_[j].neighbor[0] != i) return best;
        const MaskOutline::Places places = outline_->places(rings_, i, j, sum.px, sum.py);
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
        return limits_.allow(rings_, ring, border, place.x, place.y) &&
               (!along_outline(i, j) || outline_->allows(rings_, i, j, place.x, place.y));
    }

    float cost_at(Id i, Id j, const Q& sum, const Placement& place) const {
        return priority(i, j, sum.at(place.x, place.y) - quadrics_[i].error - quadrics_[j].error);
    }

    // What an edge is filed by, from what its merge adds to the error.
    float priority(Id i, Id j, float added) const {
        added = std::max(0.0f, added);
        return params_.total_priority ? added + (quadrics_[i].error + quadrics_[j].error) : added;
    }

    // The cheapest legal one of midpoint and ends, or of the outline's places.
    Placement fallback(Id i, Id j, const MergedRing& ring, const Q& sum) {
        const auto legal = [&](const Placement& p) { return allowed(i, j, ring, p); };
        if (along_outline(i, j)) return outline_place(i, j, sum, legal);
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
                    postponed_ = std::min(postponed_, place.cost);
                return;
            }
        }
        const float total = sum.at(place.x, place.y);
        if (total > target_.max_error) return;
        if (hooks_.before && !may_happen(i, j, sum, place)) return;
        error_ = std::max(error_, static_cast<double>(total));
        if (outline_) outline_->merge(rings_, i, j, place.x, place.y);
        apply_merge(rings_, i, j, ring);
        rings_[i].x = place.x;
        rings_[i].y = place.y;
        quadrics_[i] = sum;
        --vertices_;
        faces_ -= ring.faces_removed;
        ++collapses_;
        for (int k = 0; k < rings_[i].valence; ++k) file(i, rings_[i].neighbor[k]);
        file_batch();
    }

    // What the follower says to a collapse.
    bool may_happen(Id i, Id j, const Q& sum, const Placement& place) const {
        std::array<float, Q::kChannels> feature;
        for (int c = 0; c < Q::kChannels; ++c)
            feature[static_cast<std::size_t>(c)] = sum.feature(c, place.x, place.y);
        return hooks_.before({i, j, place.x, place.y, feature});
    }

    // Files edge (i, j) if it costs less than the threshold; interior ones wait for file_batch().
    void file(Id i, Id j) {
        if constexpr (kBatched) {
            if (!rings_[i].border() && !rings_[j].border()) {
                batch_edges_[batch_size_] = {i, j};
                batch_.set(batch_size_, quadrics_[i], quadrics_[j]);
                if (++batch_size_ == EdgeBatch<Q>::kWidth) file_batch();
                return;
            }
        }
        file_at(i, j, minimiser(i, j, merged(quadrics_[i], quadrics_[j])).cost);
    }

    void file_batch() {
        if (batch_size_ == 0) return;
        batch_.evaluate();
        for (int lane = 0; lane < batch_size_; ++lane) {
            const auto [i, j] = batch_edges_[lane];
            file_at(i, j, priority(i, j, batch_.increment(lane)));
        }
        batch_size_ = 0;
    }

    void file_at(Id i, Id j, float cost) {
        if (cost < threshold_)
            queue_.push(cost, {i, j, rings_[i].version, rings_[j].version});
        else
            postponed_ = std::min(postponed_, cost);
    }

    // Files the edges of the vertices of a tile, each edge with its end of the lower number.
    void file_tile(int left, int top, int side) {
        for (int y = top; y < std::min(top + side, height_); ++y)
            for (int x = left; x < std::min(left + side, width_); ++x) {
                const Id i = static_cast<Id>(y) * static_cast<Id>(width_) + static_cast<Id>(x);
                file_edges_up(i);
            }
        // A cut-out's further vertices, which have no place of their own among the pixels.
        if (left == 0 && top == 0)
            for (Id i = static_cast<Id>(width_) * static_cast<Id>(height_); i < rings_.size(); ++i)
                file_edges_up(i);
        file_batch();
    }

    void file_edges_up(Id i) {
        for (int k = 0; k < rings_[i].valence; ++k)
            if (i < rings_[i].neighbor[k]) file(i, rings_[i].neighbor[k]);
    }

    // The costs of edges of some vertices all over the picture; of those that may collapse, in ascending
    // order.
    std::vector<float> sampled_costs() const {
        constexpr std::size_t kSampled = 4096;
        const std::size_t step = std::max<std::size_t>(1, static_cast<std::size_t>(vertices_) / kSampled);
        std::vector<float> costs;
        std::size_t live = 0;
        for (Id v = 0; v < rings_.size(); ++v) {
            if (!rings_[v].live() || live++ % step != 0) continue;
            const Id n = rings_[v].neighbor[0];
            const float cost = minimiser(v, n, merged(quadrics_[v], quadrics_[n])).cost;
            if (cost < kNever) costs.push_back(cost);
        }
        std::sort(costs.begin(), costs.end());
        return costs;
    }

    void rebuild_quadrics() {
        quadrics_ = rebuilt_quadrics(rings_, quadrics_, params_);
        threshold_ = first_threshold();
        next_rebuild_ = vertices_ / 2;
    }

    // The median, so that the first window holds about half of the edges.
    float first_threshold() const {
        const std::vector<float> costs = sampled_costs();
        return costs.empty() ? 1.0f : std::max(costs[costs.size() / 2], std::numeric_limits<float>::min());
    }

    // Whether the window may be worked off tile by tile: not where it could reach the goal, as the first
    // tiles would then pay for all.
    bool far_from_done() const {
        const std::vector<float> costs = sampled_costs();
        const auto below = std::lower_bound(costs.begin(), costs.end(), threshold_) - costs.begin();
        const double left =
            1 - static_cast<double>(below) / static_cast<double>(std::max<std::size_t>(1, costs.size()));
        const auto far = [&](std::int64_t now, std::int64_t goal) {
            return now > kTiledAbove * goal && left * static_cast<double>(now) > static_cast<double>(goal);
        };
        return far(vertices_, target_.vertices) && far(faces_, target_.faces);
    }

    // Of a quadric that may have no minimiser the edge's midpoint and ends have to be tried.
    static constexpr bool kBatched = kCanonical<Q>;

    CollapseParams params_;
    const CollapseHooks& hooks_;
    int width_, height_;
    RingMesh rings_;
    std::vector<Q> quadrics_;
    BucketQueue queue_;
    EdgeBatch<Q> batch_;
    std::array<std::pair<Id, Id>, EdgeBatch<Q>::kWidth> batch_edges_;
    int batch_size_ = 0;
    float postponed_ = kNever;  // least cost of the legal edges that are beyond the current threshold
    float threshold_ = 0;       // of the current window
    StarLimits limits_;
    std::optional<MaskOutline> outline_;  // of a cut-out
    CollapseTarget target_;
    std::int64_t dense_vertices_, vertices_, next_rebuild_, faces_, collapses_ = 0;
    double error_ = 0;
};

}  // namespace imgmesh
