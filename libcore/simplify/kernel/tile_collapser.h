// The inner loop of simplify for a tile of a mesh that is far from its goal. There is no queue: an edge
// collapses as soon as it is the cheapest one at both of its ends. That is the order of a queue wherever a
// merge makes the edges around it no cheaper, as edges apart do not change each other's costs. The chain of
// neighbours that leads to such an edge is that of Benzecri's clustering (1982); it goes to where the work
// is, so most of what a collapse touches has just been touched.
//
// Steps: (1) a tile's vertices are copied, with small numbers; (2) the costs of all edges are kept beside
// their ends; (3) from each vertex the chain of cheapest edges is followed, and the edge at its end
// collapses, until no edge of the vertex is below the threshold; (4) what is left is written back.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <span>
#include <type_traits>
#include <vector>

#include "libcore/simplify/kernel/collapse_stats.h"
#include "libcore/simplify/kernel/edge_costs.h"
#include "libcore/simplify/kernel/quadric_mesh.h"
#include "libcore/simplify/kernel/tile_content.h"
#include "libcore/simplify/quadrics/quadric_lanes.h"

namespace imgmesh {

/// `Q` is the quadric that vertices carry (edge_costs.h). Keeps its memory from tile to tile.
template <class Q>
class TileCollapser {
  public:
    explicit TileCollapser(const SimplifyRules& rules)
        : rules_(rules), costs_(tile_.vertices, tile_.quadrics, rules) {}

    /// Copies the vertices of `list`. They must stay as they are until store(), while the mesh may change
    /// elsewhere. Vertices with a neighbour elsewhere are locked, and so are those on the boundary of a
    /// masked image: they and their edges will stay.
    ///
    /// list        fewer than kNotInTile vertices
    /// number(v)   the place of vertex v in the list, kNoTileId where it is not in it
    template <class Number>
    void load(const QuadricMesh<Q>& mesh, std::span<const Id> list, const Number& number) {
        assert(list.size() < kNotInTile);
        tile_.copy(mesh, list, number, rules_.boundary != nullptr);
        evaluate_all();
    }

    /// The same for the pixels of a rectangle, row by row, as fill_tile() and load() would have it, without a
    /// mesh in between. For colours without a mask, by what a merge adds.
    ///
    /// gradients   reach to the neighbours of the rectangle
    void load_grid(const GridMesh& grid, const PixelRect& rect, const FeaturePatch& gradients) {
        tile_.copy(grid, rect, gradients, rules_.params.geometry_weight);
        TileId v = 0;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x, ++v)
                if (on_rim(rect, x, y)) evaluate_rim(v);
    }

    /// The vertices as they stand, in the order of what was loaded.
    const std::vector<TileVertex>& vertices() const { return tile_.vertices; }
    const std::vector<TileRing>& rings() const { return tile_.rings; }
    const std::vector<Q>& quadrics() const { return tile_.quadrics; }

    /// Collapses edges that cost less than `threshold` and may collapse, until there is none left or as many
    /// vertices or faces are removed as may go.
    CollapseStats run(float threshold, const CollapseStats& may_go) {
        stats_ = {};
        may_go_ = may_go;
        threshold_ = short_cost(threshold);
        collapse_all();
        stats_.postponed = least_left();
        return stats_;
    }

    /// Writes the vertices back to where they come from.
    void store(QuadricMesh<Q>& mesh, std::span<const Id> list) const { tile_.store(mesh, list); }

  private:
    // Steps in three forms: with everything that they call built for AVX-512 (for its registers: vectors stay
    // as long), for AVX2, and for any processor.
    void evaluate_all() {
#if defined(__x86_64__)
        if (kColor && has_avx512()) return evaluate_avx512();
        if (kColor && has_avx2()) return evaluate_avx2();
#endif
        evaluate_here();
    }
    void collapse_all() {
#if defined(__x86_64__)
        if (kColor && has_avx512()) return collapse_avx512();
        if (kColor && has_avx2()) return collapse_avx2();
#endif
        collapse_here();
    }
#if defined(__x86_64__)
    IMGMESH_AVX512 __attribute__((flatten)) void evaluate_avx512() {
        evaluate_here();
    }
    IMGMESH_AVX512 __attribute__((flatten)) void collapse_avx512() {
        collapse_here();
    }
    __attribute__((target("avx2"), flatten)) void evaluate_avx2() {
        evaluate_here();
    }
    __attribute__((target("avx2"), flatten)) void collapse_avx2() {
        collapse_here();
    }
#endif
    IMGMESH_INLINE void evaluate_here() {
        for (TileId v = 0; v < tile_.vertices.size(); ++v)
            if (tile_.vertices[v].live() && !tile_.vertices[v].locked) evaluate_later_edges(v);
    }
    IMGMESH_INLINE void collapse_here() {
        chain_.resize(kFirstChain);
        for (TileId v = 0; v < tile_.vertices.size() && !stats_.reached(may_go_); ++v) {
            follow(v);
            while (!merged_.empty()) {
                const TileId start = merged_.back();
                merged_.pop_back();
                follow(start);
            }
        }
    }

    // A vertex on the rim of a rectangle: one that stays, or one on the border.
    void evaluate_rim(TileId v) {
        for (int k = 0; k < tile_.vertices[v].valence; ++k) {
            const TileId n = tile_.rings[v].neighbor[k];
            if (n >= kNotInTile) continue;
            const bool may = !tile_.vertices[v].locked && !tile_.vertices[n].locked;
            set_cost(v, n, may ? cost_beside(std::min(v, n), std::max(v, n)) : kShortNever);
        }
    }

    // The edges of a vertex to those of higher numbers.
    IMGMESH_INLINE void evaluate_later_edges(TileId v) {
        TileId others[kNeighborRoom];
        int place[kNeighborRoom], count = 0;
        for (int k = 0; k < tile_.vertices[v].valence; ++k) {
            const TileId n = tile_.rings[v].neighbor[k];
            others[count] = n;
            place[count] = k;
            count += n > v && !tile_.vertices[n].locked;
        }
        ShortCost costs[kNeighborRoom];
        evaluate(v, others, count, costs);
        const bool beside = all_beside(v);
        for (int k = 0; k < count; ++k) {
            const TileId n = others[k];
            if (beside || tile_.vertices[n].border()) costs[k] = cost_beside(v, n);
            tile_.rings[v].cost[place[k]] = costs[k];
            tile_.rings[n].cost[tile_.rings[n].find(v)] = costs[k];
        }
    }

    // The costs of edges of vertex i to vertices that are not on the border, unless all_beside(i). Both
    // arrays have kNeighborRoom places; those behind `count` are overwritten.
    IMGMESH_INLINE void evaluate(TileId i, TileId* others, int count, ShortCost* costs) const {
        if constexpr (kColor) {
            fill16_from(others, count, i);
            const ColorQuadric8 own = in_every_lane(tile_.quadrics[i]);
            for (int k = 0; k < count; k += 8) {
                short_costs(merged_minimum(own, side_by_side(tile_.quadrics.data(), others + k)).increment,
                            costs + k);
            }
        } else if constexpr (kCanonical<Q>) {
            for (int k = 0; k < count; ++k) {
                const float increment =
                    merged_minimum(tile_.quadrics[i], tile_.quadrics[others[k]]).increment;
                costs[k] = short_cost(costs_.cost(i, others[k], increment));
            }
        }
    }
    // Whether evaluate() has not given the costs of vertex i's edges, but cost_beside() will.
    bool all_beside(TileId i) const {
        return !kCanonical<Q> || tile_.vertices[i].border() || rules_.params.total_priority;
    }
    [[gnu::noinline]] ShortCost cost_beside(TileId i, TileId j) const {
        return short_cost(costs_.cost(i, j));
    }

    // The least of the costs that edges are left with.
    float least_left() const {
        ShortCost least = kShortNever;
        for (std::size_t v = 0; v < tile_.vertices.size(); ++v)
            if (tile_.vertices[v].live()) least = std::min(least, least16(tile_.rings[v].cost));
        return least_cost(least);
    }

    // Goes from a vertex to the neighbour that it is cheapest to merge with, and on from there, until that is
    // the vertex before; merges the two and goes on from the one before them. Ends where the first vertex has
    // no edge below the threshold. Costs fall along the chain, and in a tie the vertex before comes first, so
    // it never goes round.
    IMGMESH_INLINE void follow(TileId start) {
        chain_[0] = start;
        std::size_t length = 1;
        while (length > 0 && !stats_.reached(may_go_)) {
            const TileId v = chain_[length - 1];
            const TileRing& ring = tile_.rings[v];
            const ShortCost cost = least16(ring.cost);
            if (cost >= threshold_ || !tile_.vertices[v].live()) {
                --length;
                continue;
            }
            const unsigned cheapest = match16(ring.cost, cost);
            const TileId before = length > 1 ? chain_[length - 2] : kNoTileId;
            if ((cheapest & match16(ring.neighbor, before)) == 0) {
                if (length == chain_.size()) chain_.resize(2 * length);
                chain_[length++] = ring.neighbor[std::countr_zero(cheapest)];
                continue;
            }
            --length;
            if (!try_collapse(before, v, cost)) continue;
            --length;
            merged_.push_back(before);
        }
    }

    // Merges j into i. Where that is not allowed the edge becomes more expensive, and it returns false.
    IMGMESH_INLINE bool try_collapse(TileId i, TileId j, ShortCost cost) {
        MergedTileRing ring;
        if (!merge_rings(tile_.rings, tile_.vertices, i, j, ring)) return set_cost(i, j, kShortNever);
        Q sum;
        Placement place;
        bool allowed;
        const bool inside = kColor && !tile_.vertices[i].border() && !tile_.vertices[j].border();
        if (inside) {
            if constexpr (kColor) merge_colors(tile_.quadrics[i], tile_.quadrics[j], sum);
            place.x = snapped(sum.px);
            place.y = snapped(sum.py);
            allowed = shape_allowed(ring, place);
        } else {
            allowed = place_beside(i, j, ring, sum, place);
        }
        if (!allowed) {
            place = fallback(i, j, ring, sum);
            if (short_cost(place.cost) > cost) return set_cost(i, j, short_cost(place.cost));
        }
        const float total = sum.at(place.x, place.y);
        if (!inside && costs_.is_due(i, j)) {
            ++stats_.due;
        } else {
            if (total > rules_.max_error) return set_cost(i, j, kShortNever);
            stats_.error = std::max(stats_.error, static_cast<double>(total));
            stats_.increment = std::max(stats_.increment, least_cost(cost));
            ++stats_.vertices;
            stats_.faces += ring.faces_removed;
        }
        tile_.quadrics[i] = sum;
        TileVertex& vertex = tile_.vertices[i];
        vertex.x = place.x;
        vertex.y = place.y;
        vertex.fixed |= tile_.vertices[j].fixed;
        vertex.valence = static_cast<std::uint8_t>(ring.valence);
        tile_.vertices[j].valence = 0;
        merge_into_rings(i, j, ring);
        return true;
    }

    // EdgeCosts::allowed() away from the border.
    IMGMESH_INLINE bool shape_allowed(const MergedTileRing& ring, const Placement& place) const {
        ShapeLimits::Corners corners;
        const int count = ring.valence;
        for (int k = 0; k < count; ++k) {
            const TileVertex& corner = tile_.vertices[ring.neighbor[k]];
            corners.xy[2 * k] = corner.x;
            corners.xy[2 * k + 1] = corner.y;
        }
        corners.xy[2 * count] = corners.xy[0];
        corners.xy[2 * count + 1] = corners.xy[1];
        return rules_.limits.allow_here(corners, count, place.x, place.y);
    }
    // Where one end may be on the border. Returns whether the place is allowed.
    [[gnu::noinline]] bool place_beside(TileId i, TileId j, const MergedTileRing& ring, Q& sum,
                                        Placement& place) const {
        sum = merged(tile_.quadrics[i], tile_.quadrics[j]);
        place = costs_.best_place(i, j, sum);
        return costs_.allowed(i, j, ring, place);
    }
    [[gnu::noinline]] Placement fallback(TileId i, TileId j, const MergedTileRing& ring, const Q& sum) const {
        return costs_.fallback(i, j, ring, sum);
    }

    IMGMESH_INLINE bool set_cost(TileId i, TileId j, ShortCost cost) {
        tile_.rings[i].cost[tile_.rings[i].find(j)] = cost;
        tile_.rings[j].cost[tile_.rings[j].find(i)] = cost;
        return false;
    }

    // Gives i its new ring, names it i in the rings around, and evaluates its edges.
    IMGMESH_INLINE void merge_into_rings(TileId i, TileId j, const MergedTileRing& ring) {
        TileRing& own = tile_.rings[i];
        store16(own.neighbor, load16(ring.neighbor));
        TileId others[kNeighborRoom];
        store16(others, load16(ring.neighbor));
        evaluate(i, others, ring.valence, own.cost);
        fill16_from(own.cost, ring.valence, kNoEdge);
        const bool beside = all_beside(i);
        for (int k = 0; k < ring.valence; ++k) {
            const TileId n = others[k];
            TileVertex& vertex = tile_.vertices[n];
            if (vertex.locked)
                own.cost[k] = kShortNever;
            else if (beside || vertex.border())
                own.cost[k] = cost_beside(i, n);
            vertex.valence =
                static_cast<std::uint8_t>(vertex.valence - tile_.rings[n].merge(i, j, own.cost[k]));
        }
    }

    static constexpr bool kColor = std::is_same_v<Q, ColorQuadric>;
    static constexpr std::size_t kFirstChain = 64;

    const SimplifyRules& rules_;
    TileContent<Q> tile_;
    EdgeCosts<Q, std::vector<TileVertex>> costs_;
    std::vector<TileId> chain_;   // each is the cheapest to merge with for the one before
    std::vector<TileId> merged_;  // vertices that have merged since they were last looked at
    ShortCost threshold_ = 0;
    CollapseStats stats_, may_go_;
};

}  // namespace imgmesh
