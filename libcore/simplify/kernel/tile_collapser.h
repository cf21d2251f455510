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
#include "libcore/simplify/kernel/grid_costs.h"
#include "libcore/simplify/kernel/quadric_mesh.h"
#include "libcore/simplify/kernel/tile_rings.h"
#include "libcore/simplify/quadrics/quadric_lanes.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"

namespace imgmesh {

/// `Q` is the quadric that vertices carry (edge_costs.h). Keeps its memory from tile to tile.
template <class Q>
class TileCollapser {
  public:
    explicit TileCollapser(const SimplifyRules& rules) : rules_(rules), costs_(vertices_, quadrics_, rules) {}

    /// Copies the vertices of `list`. They must stay as they are until store(), while the mesh may change
    /// elsewhere. Vertices with a neighbour elsewhere are locked, and so are those on the boundary of a
    /// masked image: they and their edges will stay.
    ///
    /// list        fewer than kNotInTile vertices
    /// number(v)   the place of vertex v in the list, kNoTileId where it is not in it
    template <class Number>
    void load(const QuadricMesh<Q>& mesh, std::span<const Id> list, const Number& number) {
        assert(list.size() < kNotInTile);
        copy(mesh, list, number);
        evaluate_all();
    }

    /// The same for the pixels of a rectangle, row by row, as fill_tile() and load() would have it, without a
    /// mesh in between. For colours without a mask, by what a merge adds.
    ///
    /// gradients   reach to the neighbours of the rectangle
    void load_grid(const GridMesh& grid, const PixelRect& rect, const FeaturePatch& gradients) {
        const auto w = static_cast<std::size_t>(rect.width()),
                   count = w * static_cast<std::size_t>(rect.height());
        rings_.resize(count);
        vertices_.resize(count);
        quadrics_.resize(count);
        vertex_quadrics(grid, gradients, rules_.params.geometry_weight, rect, quadrics_.data());
        grid_costs(grid, rect, quadrics_.data(), grid_costs_);
        TileId v = 0;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x, ++v)
                if (on_rim(rect, x, y))
                    copy_rim(grid, rect, v, x, y);
                else
                    copy_inner(grid, v, static_cast<TileId>(w), x, y);
        v = 0;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x, ++v)
                if (on_rim(rect, x, y)) evaluate_rim(v);
    }

    /// The vertices as they stand, in the order of what was loaded.
    const std::vector<TileVertex>& vertices() const { return vertices_; }
    const std::vector<TileRing>& rings() const { return rings_; }
    const std::vector<Q>& quadrics() const { return quadrics_; }

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
    void store(QuadricMesh<Q>& mesh, std::span<const Id> list) const {
        for (std::size_t v = 0; v < list.size(); ++v) {
            Ring& to = mesh.rings[list[v]];
            const TileVertex& vertex = vertices_[v];
            if (vertex.live()) {
                const Ring before = to;
                to.x = vertex.x;
                to.y = vertex.y;
                to.fixed = vertex.fixed;
                for (int k = 0; k < vertex.valence; ++k) {
                    const TileId n = rings_[v].neighbor[k];
                    to.neighbor[k] = n < kNotInTile ? list[n] : before.neighbor[n - kNotInTile];
                }
                mesh.quadrics[list[v]] = quadrics_[v];
            }
            to.valence = vertex.valence;
        }
    }

  private:
    template <class Number>
    void copy(const QuadricMesh<Q>& mesh, std::span<const Id> list, const Number& number) {
        rings_.resize(list.size());
        vertices_.resize(list.size());
        quadrics_.resize(list.size());
        for (TileId v = 0; v < list.size(); ++v) {
            copy(v, mesh.rings[list[v]], number);
            quadrics_[v] = mesh.quadrics[list[v]];
        }
    }
    template <class Number>
    void copy(TileId v, const Ring& from, const Number& number) {
        TileRing& ring = rings_[v];
        fill16_from(ring.neighbor, 0, kNoTileId);
        fill16_from(ring.cost, 0, kNoEdge);
        bool locked = rules_.boundary != nullptr && from.border();
        for (int k = 0; k < from.valence; ++k) {
            const TileId n = number(from.neighbor[k]);
            locked |= n == kNoTileId;
            ring.neighbor[k] = n == kNoTileId ? static_cast<TileId>(kNotInTile + k) : n;
            ring.cost[k] = kShortNever;
        }
        vertices_[v] = {from.x, from.y, from.valence, from.fixed, locked || from.locked};
    }

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
        for (TileId v = 0; v < vertices_.size(); ++v)
            if (vertices_[v].live() && !vertices_[v].locked) evaluate_later_edges(v);
    }
    IMGMESH_INLINE void collapse_here() {
        chain_.resize(kFirstChain);
        for (TileId v = 0; v < vertices_.size() && !stats_.reached(may_go_); ++v) {
            follow(v);
            while (!merged_.empty()) {
                const TileId start = merged_.back();
                merged_.pop_back();
                follow(start);
            }
        }
    }

    static bool on_rim(const PixelRect& rect, int x, int y) {
        return x == rect.left || x + 1 == rect.right || y == rect.top || y + 1 == rect.bottom;
    }
    // All neighbours of pixel (x, y) are in the rectangle: in the order of inner_ring().
    void copy_inner(const GridMesh& grid, TileId v, TileId stride, int x, int y) {
        vertices_[v] = {grid.origin_x + static_cast<float>(x), grid.origin_y + static_cast<float>(y), 0, 0,
                        false};
        TileRing& ring = rings_[v];
        fill16_from(ring.neighbor, 0, kNoTileId);
        fill16_from(ring.cost, 0, kNoEdge);
        const std::size_t here = v, north = here - stride, south = here + stride;
        const GridCosts& costs = grid_costs_;
        int k = 0;
        // Diagonals are written wherever there might be one, and overwritten where there is none.
        const auto push = [&](std::size_t n, ShortCost cost, bool there) {
            ring.neighbor[k] = static_cast<TileId>(n);
            ring.cost[k] = cost;
            k += there;
        };
        push(here + 1, costs.east[here], true);
        push(north + 1, costs.cell[north], !grid.falling_diagonal(x, y - 1));
        push(north, costs.south[north], true);
        push(north - 1, costs.cell[north - 1], grid.falling_diagonal(x - 1, y - 1));
        push(here - 1, costs.east[here - 1], true);
        push(south - 1, costs.cell[here - 1], !grid.falling_diagonal(x - 1, y));
        push(south, costs.south[here], true);
        push(south + 1, costs.cell[here], grid.falling_diagonal(x, y));
        ring.neighbor[k] = kNoTileId;
        ring.cost[k] = kNoEdge;
        vertices_[v].valence = static_cast<std::uint8_t>(k);
    }
    void copy_rim(const GridMesh& grid, const PixelRect& rect, TileId v, int x, int y) {
        const auto w = static_cast<Id>(grid.feature.width);
        copy(v, grid_ring(grid, x, y), [&](Id n) {
            const int nx = static_cast<int>(n % w), ny = static_cast<int>(n / w);
            const bool here = nx >= rect.left && nx < rect.right && ny >= rect.top && ny < rect.bottom;
            return here ? static_cast<TileId>((ny - rect.top) * rect.width() + nx - rect.left) : kNoTileId;
        });
    }
    // A vertex on the rim of a rectangle: one that stays, or one on the border.
    void evaluate_rim(TileId v) {
        for (int k = 0; k < vertices_[v].valence; ++k) {
            const TileId n = rings_[v].neighbor[k];
            if (n >= kNotInTile) continue;
            const bool may = !vertices_[v].locked && !vertices_[n].locked;
            set_cost(v, n, may ? cost_beside(std::min(v, n), std::max(v, n)) : kShortNever);
        }
    }

    // The edges of a vertex to those of higher numbers.
    IMGMESH_INLINE void evaluate_later_edges(TileId v) {
        TileId others[kNeighborRoom];
        int place[kNeighborRoom], count = 0;
        for (int k = 0; k < vertices_[v].valence; ++k) {
            const TileId n = rings_[v].neighbor[k];
            others[count] = n;
            place[count] = k;
            count += n > v && !vertices_[n].locked;
        }
        ShortCost costs[kNeighborRoom];
        evaluate(v, others, count, costs);
        const bool beside = all_beside(v);
        for (int k = 0; k < count; ++k) {
            const TileId n = others[k];
            if (beside || vertices_[n].border()) costs[k] = cost_beside(v, n);
            rings_[v].cost[place[k]] = costs[k];
            rings_[n].cost[rings_[n].find(v)] = costs[k];
        }
    }

    // The costs of edges of vertex i to vertices that are not on the border, unless all_beside(i). Both
    // arrays have kNeighborRoom places; those behind `count` are overwritten.
    IMGMESH_INLINE void evaluate(TileId i, TileId* others, int count, ShortCost* costs) const {
        if constexpr (kColor) {
            fill16_from(others, count, i);
            const ColorQuadric8 own = in_every_lane(quadrics_[i]);
            for (int k = 0; k < count; k += 8) {
                short_costs(merged_minimum(own, side_by_side(quadrics_.data(), others + k)).increment,
                            costs + k);
            }
        } else if constexpr (kCanonical<Q>) {
            for (int k = 0; k < count; ++k) {
                const float increment = merged_minimum(quadrics_[i], quadrics_[others[k]]).increment;
                costs[k] = short_cost(costs_.cost(i, others[k], increment));
            }
        }
    }
    // Whether evaluate() has not given the costs of vertex i's edges, but cost_beside() will.
    bool all_beside(TileId i) const {
        return !kCanonical<Q> || vertices_[i].border() || rules_.params.total_priority;
    }
    [[gnu::noinline]] ShortCost cost_beside(TileId i, TileId j) const {
        return short_cost(costs_.cost(i, j));
    }

    // The least of the costs that edges are left with.
    float least_left() const {
        ShortCost least = kShortNever;
        for (std::size_t v = 0; v < vertices_.size(); ++v)
            if (vertices_[v].live()) least = std::min(least, least16(rings_[v].cost));
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
            const TileRing& ring = rings_[v];
            const ShortCost cost = least16(ring.cost);
            if (cost >= threshold_ || !vertices_[v].live()) {
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
        if (!merge_rings(rings_, vertices_, i, j, ring)) return set_cost(i, j, kShortNever);
        Q sum;
        Placement place;
        bool allowed;
        const bool inside = kColor && !vertices_[i].border() && !vertices_[j].border();
        if (inside) {
            if constexpr (kColor) merge_colors(quadrics_[i], quadrics_[j], sum);
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
        if (total > rules_.max_error) return set_cost(i, j, kShortNever);
        stats_.error = std::max(stats_.error, static_cast<double>(total));
        ++stats_.vertices;
        stats_.faces += ring.faces_removed;
        quadrics_[i] = sum;
        TileVertex& vertex = vertices_[i];
        vertex.x = place.x;
        vertex.y = place.y;
        vertex.fixed |= vertices_[j].fixed;
        vertex.valence = static_cast<std::uint8_t>(ring.valence);
        vertices_[j].valence = 0;
        merge_into_rings(i, j, ring);
        return true;
    }

    // EdgeCosts::allowed() away from the border.
    IMGMESH_INLINE bool shape_allowed(const MergedTileRing& ring, const Placement& place) const {
        ShapeLimits::Corners corners;
        const int count = ring.valence;
        for (int k = 0; k < count; ++k) {
            const TileVertex& corner = vertices_[ring.neighbor[k]];
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
        sum = merged(quadrics_[i], quadrics_[j]);
        place = costs_.best_place(i, j, sum);
        return costs_.allowed(i, j, ring, place);
    }
    [[gnu::noinline]] Placement fallback(TileId i, TileId j, const MergedTileRing& ring, const Q& sum) const {
        return costs_.fallback(i, j, ring, sum);
    }

    IMGMESH_INLINE bool set_cost(TileId i, TileId j, ShortCost cost) {
        rings_[i].cost[rings_[i].find(j)] = cost;
        rings_[j].cost[rings_[j].find(i)] = cost;
        return false;
    }

    // Gives i its new ring, names it i in the rings around, and evaluates its edges.
    IMGMESH_INLINE void merge_into_rings(TileId i, TileId j, const MergedTileRing& ring) {
        TileRing& own = rings_[i];
        store16(own.neighbor, load16(ring.neighbor));
        TileId others[kNeighborRoom];
        store16(others, load16(ring.neighbor));
        evaluate(i, others, ring.valence, own.cost);
        fill16_from(own.cost, ring.valence, kNoEdge);
        const bool beside = all_beside(i);
        for (int k = 0; k < ring.valence; ++k) {
            const TileId n = others[k];
            TileVertex& vertex = vertices_[n];
            if (vertex.locked)
                own.cost[k] = kShortNever;
            else if (beside || vertex.border())
                own.cost[k] = cost_beside(i, n);
            vertex.valence = static_cast<std::uint8_t>(vertex.valence - rings_[n].merge(i, j, own.cost[k]));
        }
    }

    static constexpr bool kColor = std::is_same_v<Q, ColorQuadric>;
    static constexpr std::size_t kFirstChain = 64;

    const SimplifyRules& rules_;
    std::vector<TileRing> rings_;
    std::vector<TileVertex> vertices_;
    std::vector<Q> quadrics_;
    EdgeCosts<Q, std::vector<TileVertex>> costs_;
    GridCosts grid_costs_;
    std::vector<TileId> chain_;   // each is the cheapest to merge with for the one before
    std::vector<TileId> merged_;  // vertices that have merged since they were last looked at
    ShortCost threshold_ = 0;
    CollapseStats stats_, may_go_;
};

}  // namespace imgmesh
