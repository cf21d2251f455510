// The engine of simplify: the schedule by which its inner loops (tile_collapser.h, edge_collapser.h) get to
// the goal.
//
// Steps: (1) the dense mesh tile by tile, until about an eighth of it is left (start_in_tiles.h); (2) rounds
// of larger tiles while the goal is far (round_in_tiles.h); (3) the whole mesh at once. Each step works in
// windows: only edges below a threshold are looked at, and the threshold rises from one to the next. Figures
// for what is chosen here are in docs/decisions/0019-collapse-in-tiles.md and 0046-tiles-without-a-queue.md.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "libcore/simplify/kernel/collapsed_mesh.h"
#include "libcore/simplify/kernel/edge_collapser.h"
#include "libcore/simplify/kernel/round_in_tiles.h"
#include "libcore/simplify/kernel/start_in_tiles.h"

namespace imgmesh {

// The threshold of the whole mesh rises by this factor from window to window. A larger one lets the queue
// hold edges that are never reached, a smaller one scans the mesh more often. Recheck by time and peak memory
// of `imgmesh-build --map tracked` on an image of 2048 x 2048, which has no tiles.
inline constexpr float kWindow = 4.0f;

// Rounds in tiles end where fewer vertices are left than so many times the goal, and so does each tile:
// otherwise the first tiles would pay for all. Decision 19 has the error for 4, 2 and 1.5.
inline constexpr double kTiledAbove = 1.5;

// Of rounds. Rings and quadrics of so many vertices take 512 KB, which stays in a core's own cache.
inline constexpr double kVerticesPerTile = 4096;
// Fewer vertices than in four tiles are not worth a round: threads would wait for each other, and a large
// part of the edges would be at seams.
inline constexpr std::int64_t kLeastTiled = 4 * static_cast<std::int64_t>(kVerticesPerTile);
// Rounds end too when one has taken less than this share of what it might have: what is left is at seams. It
// only saves rounds that do nothing; recheck by their number.
inline constexpr double kLeastOfRound = 1.0 / 20;

/// The engine of simplify(), whatever the kind of its quadrics.
class AnySimplifier {
  public:
    virtual ~AnySimplifier() = default;
    /// Goes on from where it stands to a target at least as coarse as the last.
    virtual SimplifyResult to(const SimplifyTarget& target, const Progress& progress) = 0;
};

/// The engine for quadrics Q. All references must outlive it.
template <class Q>
class Simplifier : public AnySimplifier {
  public:
    Simplifier(const GridMesh& grid, const SimplifyParams& params, const SimplifyHooks& hooks)
        : grid_(grid),
          params_(params),
          rules_{params_, hooks, grid.feature.channels,
                 ShapeLimits::of(params.max_face_area, params.min_shape)} {
        // A follower is told of one step at a time, and vertices have the grid's numbers.
        if (hooks.before) params_.tiles = false;
        rules_.sides_decided = !grid.side_vertices.empty();
    }

    /// From a mesh in the place of the dense one, whose sides are decided. Of `frame` only the size and the
    /// number of channels count.
    Simplifier(const GridMesh& frame, const SimplifyParams& params, const SimplifyHooks& hooks,
               QuadricMesh<Q> mesh)
        : Simplifier(frame, params, hooks) {
        mesh_ = std::move(mesh);
        rules_.sides_decided = true;
        const auto count = [&](const auto& which) {
            return std::count_if(mesh_.rings.begin(), mesh_.rings.end(), which);
        };
        const std::int64_t going = count([](const Ring& ring) { return ring.live() && must_go(ring); });
        dense_vertices_ = count([](const Ring& ring) { return ring.live(); });
        vertices_ = dense_vertices_ - going;
        faces_ = face_count(mesh_.rings) - going;
        next_rebuild_ = vertices_ / 2;
        threshold_ = first_threshold();
    }

    SimplifyResult to(const SimplifyTarget& target, const Progress& progress) override {
        run(target, progress);
        return snapshot();
    }

  private:
    void run(const SimplifyTarget& target, const Progress& progress) {
        if (mesh_.rings.empty()) start(target, progress);
        set_target(target);
        while (!done()) {
            if (params_.rebuild_quadrics && near_rebuild()) rebuild_quadrics();
            const bool tiled = params_.tiles && !rules_.hooks.after && far_from_done();
            const double might_go = tiled ? share_that_goes() * static_cast<double>(vertices_) : 0;
            const CollapseStats part = tiled ? round_of_tiles() : whole();
            take(part);
            if (progress) progress(fraction_done(), "collapse");
            if (tiled) {
                tiles_over_ = static_cast<double>(part.vertices) < kLeastOfRound * might_go;
                threshold_ *= kTileWindow;
                continue;
            }
            if (done() || (part.vertices == 0 && part.postponed == kNever)) break;
            if (threshold_ > rules_.max_increment) {
                if (part.vertices == 0) break;
                continue;  // until no edge below the limit is left
            }
            // Where nothing has changed, windows below the cheapest edge would stay empty. The first window
            // of an image with flat parts is far below what the rest costs.
            do threshold_ *= kWindow;
            while (part.vertices == 0 && threshold_ <= part.postponed);
        }
    }

    SimplifyResult snapshot() const {
        return {collapsed_mesh(mesh_, rules_.channels, rules_.sides_decided), error_,
                dense_vertices_ - vertices_, increment_};
    }

    // Edges that cost as much or more are not looked at for now.
    float window() const { return std::min(threshold_, std::nextafter(rules_.max_increment, kNever)); }

    bool done() const { return vertices_ <= target_.vertices || faces_ <= target_.faces; }
    double fraction_done(std::int64_t removed = 0) const {
        const auto begin = static_cast<double>(dense_vertices_),
                   left = static_cast<double>(vertices_ - removed);
        return (begin - left) / std::max(1.0, begin - static_cast<double>(target_.vertices));
    }

    void set_target(const SimplifyTarget& target) {
        target_ = target;
        target_.faces = std::max(target.faces,
                                 static_cast<std::int64_t>(target.face_share * static_cast<double>(faces_)));
        rules_.max_error = target.max_error;
        rules_.max_increment = static_cast<float>(target.max_increment);
        if (rules_.max_increment < kNever) tiles_over_ = false;
    }

    void take(const CollapseStats& part) {
        vertices_ -= part.vertices;
        faces_ -= part.faces;
        error_ = std::max(error_, part.error);
        increment_ = std::max(increment_, double{part.increment});
    }

    // Makes the dense mesh, or what its tiles leave of it.
    void start(const SimplifyTarget& target, const Progress& progress) {
        if constexpr (kCanonical<Q>) {
            if (params_.tiles && !params_.total_priority) {
                count_dense();
                next_rebuild_ = 0;  // tiles have their own
                set_target(target);
                const double share = std::max(grid_.mask.empty() ? kStartShare : kMaskedStartShare,
                                              kStartAbove * (1 - share_that_goes()));
                if (share < kMostStartShare) {
                    threshold_ = start_threshold<Q>(grid_, rules_, share);
                    take(start_in_tiles(grid_, rules_, window(), share, share_that_goes(), mesh_,
                                        [&](std::int64_t removed) {
                                            if (progress) progress(fraction_done(removed), "collapse");
                                        }));
                    threshold_ *= kTileWindow;
                    next_rebuild_ = vertices_ / 2;
                    if (!grid_.mask.empty())
                        rules_.boundary = &boundary_.emplace(grid_, mesh_.rings, mesh_.pixel);
                    return;
                }
            }
        }
        mesh_.rings = ring_mesh(grid_);
        mesh_.quadrics = initial_quadrics<Q>(
            grid_, mesh_.rings, smoothed_patch(grid_, params_.smoothing, whole_rect(grid_)), params_);
        count_dense();
        next_rebuild_ = vertices_ / 2;
        if (!grid_.mask.empty()) rules_.boundary = &boundary_.emplace(grid_, mesh_.rings, mesh_.pixel);
        threshold_ = first_threshold();
    }

    void count_dense() {
        const auto w = std::int64_t{grid_.feature.width}, h = std::int64_t{grid_.feature.height};
        const bool masked = !grid_.mask.empty();
        dense_vertices_ =
            masked ? grid_.mask.count() + static_cast<std::int64_t>(grid_.copies.size()) : w * h;
        const std::int64_t going = side_vertices_to_go(grid_);
        faces_ = (masked ? masked_face_count(grid_) : 2 * (w - 1) * (h - 1)) - going;
        vertices_ = dense_vertices_ - going;
    }

    // The share of its vertices that each tile may remove. Without such a limit one tile could use up the
    // whole budget.
    double share_that_goes() const {
        const auto share = [](std::int64_t now, std::int64_t goal) {
            return 1 - kTiledAbove * static_cast<double>(goal) /
                           static_cast<double>(std::max<std::int64_t>(1, now));
        };
        const double goes = std::min(share(vertices_, target_.vertices), share(faces_, target_.faces));
        return params_.rebuild_quadrics
                   ? std::min(goes, 1 - static_cast<double>(next_rebuild_) / static_cast<double>(vertices_))
                   : goes;
    }

    CollapseStats round_of_tiles() {
        const RoundTiles tiles(grid_.feature.width, grid_.feature.height, vertices_, kVerticesPerTile,
                               ++rounds_);
        CollapseStats sum = round_in_tiles(mesh_, rules_, tiles, window(), share_that_goes());
        if (!rules_.boundary && !rules_.sides_decided) return sum;
        // The boundary is one object, so one thread at a time may change it. What must go from a side may do
        // so now where it could not before; there is little of it.
        CollapseStats may_go = left_to_go();
        may_go.vertices -= sum.vertices;
        may_go.faces -= sum.faces;
        EdgeCollapser<Q> collapser(mesh_, rules_);
        std::vector<Id> border;
        for (Id v = 0; v < mesh_.rings.size(); ++v)
            if (mesh_.rings[v].live() &&
                (rules_.boundary ? mesh_.rings[v].border() : must_go(mesh_.rings[v])))
                border.push_back(v);
        sum.add(collapser.run(
            border.size(), [&](std::size_t n) { return border[n]; }, window(), may_go, true));
        return sum;
    }

    CollapseStats whole() {
        EdgeCollapser<Q> collapser(mesh_, rules_);
        return collapser.run(
            mesh_.rings.size(), [](std::size_t v) { return static_cast<Id>(v); }, window(), left_to_go());
    }

    CollapseStats left_to_go() const {
        return {.vertices = vertices_ - target_.vertices, .faces = faces_ - target_.faces};
    }

    bool near_rebuild() const {
        return static_cast<double>(vertices_) <= kHalved * static_cast<double>(next_rebuild_);
    }

    void rebuild_quadrics() {
        mesh_.quadrics = rebuilt_quadrics(mesh_.rings, mesh_.quadrics, params_);
        threshold_ = first_threshold();
        next_rebuild_ = vertices_ / 2;
    }

    // Costs of edges that may collapse, one of each of some vertices all over the image.
    std::vector<float> sampled_costs() const {
        const EdgeCosts<Q> edges(mesh_, rules_);
        const std::size_t step = std::max<std::size_t>(1, mesh_.rings.size() / kSampled);
        std::vector<float> costs;
        for (std::size_t v = 0; v < mesh_.rings.size(); v += step) {
            if (!mesh_.rings[v].live()) continue;
            const float cost = edges.cost(static_cast<Id>(v), mesh_.rings[v].neighbor[0]);
            if (cost < kNever) costs.push_back(cost);
        }
        return costs;
    }

    // So that the first window holds about half of the edges. Where none may collapse any value will do.
    float first_threshold() const {
        const std::vector<float> costs = sampled_costs();
        return costs.empty() ? 1.0f : std::max(median(costs), std::numeric_limits<float>::min());
    }

    bool far_from_done() const {
        if (tiles_over_ || vertices_ < kLeastTiled || threshold_ > rules_.max_increment) return false;
        const std::vector<float> costs = sampled_costs();
        const auto below =
            std::count_if(costs.begin(), costs.end(), [&](float cost) { return cost < threshold_; });
        const double left =
            1 - static_cast<double>(below) / static_cast<double>(std::max<std::size_t>(1, costs.size()));
        return share_that_goes() > 0 &&
               left * static_cast<double>(vertices_) > static_cast<double>(target_.vertices) &&
               left * static_cast<double>(faces_) > static_cast<double>(target_.faces);
    }

    // Vertices whose edges are sampled: the median of so many is within 2 % of the true rank, and they cost
    // less than a tile of a round.
    static constexpr std::size_t kSampled = 4096;
    // Quadrics are rebuilt when the vertices have nearly halved. From tile to tile less than a half may go at
    // first, and the last of it would take many rounds. 1.05 to 1.3 make no difference in time, and the
    // larger is the lower in error.
    static constexpr double kHalved = 1.25;
    // The share of the vertices that the first tiles leave. It is small enough that the rest needs little of
    // the dense mesh's memory and time; seams do not show in the result (decision 19). Of a masked image more
    // is left, as its boundary waits meanwhile.
    static constexpr double kStartShare = 0.12, kMaskedStartShare = 0.2;
    // Where the goal is near, the start leaves this many times what rounds would leave. Above the last share
    // there is no start: one that leaves half takes more memory than none (decision 19).
    static constexpr double kStartAbove = 1.3, kMostStartShare = 0.7;

    const GridMesh& grid_;
    SimplifyParams params_;
    SimplifyRules rules_;
    std::optional<MaskBoundary> boundary_;  // of a masked image
    QuadricMesh<Q> mesh_;
    float threshold_ = 0;  // of the current window
    int rounds_ = 0;
    bool tiles_over_ = false;
    SimplifyTarget target_;
    std::int64_t dense_vertices_ = 0, next_rebuild_ = 0;
    std::int64_t vertices_ = 0, faces_ = 0;  // as if all were gone that must go from the sides
    double error_ = 0, increment_ = 0;
};

}  // namespace imgmesh
