// Steps: (1) a quadric for every vertex; (2) edges are filed by the error that merging their ends would add;
// (3) the cheapest edge whose merge keeps the mesh a triangulation is collapsed, and the edges around it are
// filed anew; (4) until a limit is reached. Sources: paper sec. 3.1, 3.2; Garland and Heckbert 1997; Hoppe
// 1999.
#include "libcore/collapse/collapse_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libcore/collapse/bucket_queue.h"
#include "libcore/collapse/ring_mesh.h"
#include "libcore/collapse/vertex_quadrics.h"

namespace imgmesh {
namespace {

constexpr int C = 3;
constexpr float kNever = std::numeric_limits<float>::infinity();

// Every new triangle keeps 2 area > kFatness longest^2. 0.2 costs 8 % of RMS and lifts the smallest angle
// from 3.6 to 12 degrees; with none, slivers appear.
constexpr float kFatness = 0.05f;

// The queue holds only edges cheaper than a threshold, which rises by this factor when they are used up.
// Larger wastes memory, smaller scans the mesh more often.
constexpr float kWindow = 8.0f;

float snapped(float x) {
    return std::round(x / kPositionStep) * kPositionStep;
}

struct Placement {
    float x = 0, y = 0;
    float cost = kNever;  // what the merge adds to the error; kNever where it is not allowed
};

class Collapser {
  public:
    Collapser(const GridMesh& grid, const CollapseParams& params)
        : params_(params),
          rings_(ring_mesh(grid)),
          quadrics_(vertex_quadrics(grid, smoothed(grid.feature, params.smoothing), params.geometry_weight)),
          vertices_(static_cast<std::int64_t>(rings_.size())),
          faces_(std::int64_t{2} * (grid.feature.width - 1) * (grid.feature.height - 1)) {}

    void run(const Progress& progress) {
        const std::int64_t start = vertices_;
        float threshold = first_threshold();
        for (; !done(); threshold *= kWindow) {
            const std::int64_t collapses_before = result_.collapses;
            postponed_ = false;
            const float largest = file_all_below(threshold);
            while (!queue_.empty() && !done()) {
                const int bucket = queue_.lowest_bucket();
                try_collapse(queue_.pop(), bucket, threshold);
                if (progress && result_.collapses % 65536 == 0) progress(fraction_done(start), "collapse");
            }
            if (result_.collapses == collapses_before && largest < threshold && !postponed_) return;
        }
    }

    CollapseResult finish() {
        std::vector<Id> live;
        result_.mesh.channels = C;
        result_.mesh.faces = ring_faces(rings_, live);
        for (const Id v : live) {
            const Ring& ring = rings_[v];
            result_.mesh.position.emplace_back(ring.x, ring.y);
            for (int c = 0; c < C; ++c)
                result_.mesh.feature.push_back(quadrics_[v].feature(c, ring.x, ring.y));
        }
        return std::move(result_);
    }

  private:
    bool done() const { return vertices_ <= params_.target_vertices || faces_ <= params_.target_faces; }
    double fraction_done(std::int64_t start) const {
        return static_cast<double>(start - vertices_) /
               static_cast<double>(std::max<std::int64_t>(1, start - params_.target_vertices));
    }

    // What may move where: returns false where the border forbids the merge altogether.
    static bool shared_constraint(const Ring& a, const Ring& b, std::uint8_t& fixed, float& x, float& y) {
        constexpr std::uint8_t kCorner = kFixedX | kFixedY;
        if ((a.fixed & b.fixed & kFixedX) && a.x != b.x) return false;
        if ((a.fixed & b.fixed & kFixedY) && a.y != b.y) return false;
        fixed = a.fixed | b.fixed;
        if (fixed == kCorner && a.fixed != kCorner && b.fixed != kCorner) return false;
        x = a.fixed & kFixedX ? a.x : b.x;
        y = a.fixed & kFixedY ? a.y : b.y;
        return true;
    }

    // Where the merged vertex would go and what it would cost, legality of the star left aside.
    Placement minimiser(Id i, Id j) const {
        const Quadric<C>&qi = quadrics_[i], &qj = quadrics_[j];
        std::uint8_t fixed = 0;
        Placement place;
        if (!shared_constraint(rings_[i], rings_[j], fixed, place.x, place.y)) return {};
        if (fixed == 0) {
            const MergedMinimum m = merged_minimum(qi, qj);
            return {snapped(qi.px + m.qx), snapped(qi.py + m.qy), m.increment};
        }
        // On a side the position is free along one axis only; its best value there follows from S.
        const Quadric<C> sum = merged(qi, qj);
        if (fixed == kFixedX) place.y = snapped(sum.py - sum.sxy * (place.x - sum.px) / sum.syy);
        if (fixed == kFixedY) place.x = snapped(sum.px - sum.sxy * (place.y - sum.py) / sum.sxx);
        place.cost = sum.at(place.x, place.y) - qi.error - qj.error;
        return place;
    }

    bool star_is_fat(const MergedRing& ring, bool border, float x, float y) const {
        const int faces = border ? ring.valence - 1 : ring.valence;
        for (int k = 0; k < faces; ++k) {
            const Ring& a = rings_[ring.neighbor[static_cast<std::size_t>(k)]];
            const Ring& b =
                rings_[ring.neighbor[static_cast<std::size_t>(k + 1 == ring.valence ? 0 : k + 1)]];
            const float ax = a.x - x, ay = a.y - y, bx = b.x - x, by = b.y - y, ex = bx - ax, ey = by - ay;
            const float longest = std::max({ax * ax + ay * ay, bx * bx + by * by, ex * ex + ey * ey});
            if (!(ay * bx - ax * by > kFatness * longest)) return false;
        }
        return true;
    }

    // The cheapest legal one of midpoint and ends.
    Placement fallback(Id i, Id j, const MergedRing& ring, const Quadric<C>& sum) const {
        const Ring &a = rings_[i], &b = rings_[j];
        std::uint8_t fixed = 0;
        float x = 0, y = 0;
        Placement best;
        if (!shared_constraint(a, b, fixed, x, y)) return best;
        const std::pair<float, float> candidates[] = {
            {0.5f * (a.x + b.x), 0.5f * (a.y + b.y)}, {a.x, a.y}, {b.x, b.y}};
        for (const auto& [cx, cy] : candidates) {
            Placement p{fixed & kFixedX ? x : snapped(cx), fixed & kFixedY ? y : snapped(cy), 0};
            p.cost = std::max(0.0f, sum.at(p.x, p.y) - quadrics_[i].error - quadrics_[j].error);
            if (p.cost < best.cost && star_is_fat(ring, fixed != 0, p.x, p.y)) best = p;
        }
        return best;
    }

    void try_collapse(const QueuedEdge& edge, int bucket, float threshold) {
        const auto [i, j, version_i, version_j] = edge;
        if (rings_[i].version != version_i || rings_[j].version != version_j) return;
        MergedRing ring;
        if (!merge_rings(rings_, i, j, ring)) return;
        Placement place = minimiser(i, j);
        const Quadric<C> sum = merged(quadrics_[i], quadrics_[j]);
        if (!star_is_fat(ring, rings_[i].border() || rings_[j].border(), place.x, place.y)) {
            place = fallback(i, j, ring, sum);
            if (place.cost == kNever) return;
            if (BucketQueue::bucket_of(place.cost) > bucket) {
                if (place.cost < threshold)
                    queue_.push(place.cost, edge);
                else
                    postponed_ = true;
                return;
            }
        }
        const float total = sum.at(place.x, place.y);
        if (total > params_.max_error) return;
        result_.error = std::max(result_.error, static_cast<double>(total));
        apply_merge(rings_, i, j, ring);
        rings_[i].x = place.x;
        rings_[i].y = place.y;
        quadrics_[i] = sum;
        --vertices_;
        faces_ -= ring.faces_removed;
        ++result_.collapses;
        for (int k = 0; k < rings_[i].valence; ++k) file(i, rings_[i].neighbor[k], threshold);
    }

    // Files edge (i, j) if it costs less than `threshold`. Returns its cost, 0 if it may never collapse.
    float file(Id i, Id j, float threshold) {
        const float cost = std::max(0.0f, minimiser(i, j).cost);
        if (cost < threshold) queue_.push(cost, {i, j, rings_[i].version, rings_[j].version});
        return cost == kNever ? 0 : cost;
    }

    // Files every edge that costs less than `threshold`. Returns the largest cost of all.
    float file_all_below(float threshold) {
        float largest = 0;
        for (Id i = 0; i < rings_.size(); ++i)
            for (int k = 0; k < rings_[i].valence; ++k)
                if (i < rings_[i].neighbor[k])
                    largest = std::max(largest, file(i, rings_[i].neighbor[k], threshold));
        return largest;
    }

    // The median cost of a sample of edges, so that the first window holds about half of them.
    float first_threshold() const {
        constexpr std::size_t kSampled = 4096;
        std::vector<float> costs;
        for (std::size_t i = 0; i < rings_.size(); i += std::max<std::size_t>(1, rings_.size() / kSampled)) {
            const float cost = minimiser(static_cast<Id>(i), rings_[i].neighbor[0]).cost;
            if (cost < kNever) costs.push_back(cost);
        }
        if (costs.empty()) return 1.0f;
        const auto middle = costs.begin() + static_cast<std::ptrdiff_t>(costs.size() / 2);
        std::nth_element(costs.begin(), middle, costs.end());
        return std::max(*middle, std::numeric_limits<float>::min());
    }

    CollapseParams params_;
    RingMesh rings_;
    std::vector<Quadric<C>> quadrics_;
    BucketQueue queue_;
    bool postponed_ = false;  // some legal edge costs more than the current threshold
    std::int64_t vertices_, faces_;
    CollapseResult result_;
};

}  // namespace

CollapseResult collapse_edges(const GridMesh& grid, const CollapseParams& params, const Progress& progress) {
    Collapser collapser(grid, params);
    collapser.run(progress);
    return collapser.finish();
}

}  // namespace imgmesh
