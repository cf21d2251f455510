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
#include <cassert>
#include <span>
#include <vector>

#include "libcore/simplify/kernel/collapse_stats.h"
#include "libcore/simplify/kernel/edge_costs.h"
#include "libcore/simplify/kernel/quadric_mesh.h"
#include "libcore/simplify/kernel/tile_rings.h"

namespace imgmesh {

/// `Q` is the quadric that vertices carry (edge_costs.h). Keeps its memory from tile to tile.
template <class Q>
class TileCollapser {
  public:
    explicit TileCollapser(const SimplifyRules& rules) : rules_(rules), costs_(vertices_, quadrics_, rules) {}

    /// Collapses the edges between the vertices of `list` that cost less than `threshold` and may collapse,
    /// until there is none left or as many vertices or faces are removed as may go. Vertices stay as they are
    /// if they have a neighbour elsewhere, or lie on the boundary of a masked image.
    ///
    /// list        fewer than kElsewhere vertices; the mesh may change elsewhere meanwhile
    /// number(v)   the place of vertex v in the list, kNoTileId where it is not in it
    template <class Number>
    CollapseStats run(QuadricMesh<Q>& mesh, std::span<const Id> list, const Number& number, float threshold,
                      const CollapseStats& may_go) {
        assert(list.size() < kElsewhere);
        stats_ = {};
        may_go_ = may_go;
        load(mesh, list, number);
        evaluate_all();
        threshold_ = short_cost(threshold);
        for (std::size_t v = 0; v < vertices_.size() && !stats_.reached(may_go_); ++v) {
            merged_.assign(1, static_cast<TileId>(v));
            while (!merged_.empty()) {
                const TileId start = merged_.back();
                merged_.pop_back();
                follow(start);
            }
        }
        stats_.postponed = least_left();
        store(mesh, list);
        return stats_;
    }

  private:
    template <class Number>
    void load(const QuadricMesh<Q>& mesh, std::span<const Id> list, const Number& number) {
        rings_.resize(list.size());
        vertices_.resize(list.size());
        quadrics_.resize(list.size());
        for (std::size_t v = 0; v < list.size(); ++v) {
            const Ring& from = mesh.rings[list[v]];
            TileRing& ring = rings_[v];
            std::fill_n(ring.neighbor, TileRing::kRoom, kNoTileId);
            std::fill_n(ring.cost, TileRing::kRoom, kNoEdge);
            bool locked = rules_.boundary != nullptr && from.border();
            for (int k = 0; k < from.valence; ++k) {
                const TileId n = number(from.neighbor[k]);
                locked |= n == kNoTileId;
                ring.neighbor[k] = n == kNoTileId ? static_cast<TileId>(kElsewhere + k) : n;
                ring.cost[k] = kShortNever;
            }
            vertices_[v] = {from.x, from.y, from.valence, from.fixed, locked || from.locked};
            quadrics_[v] = mesh.quadrics[list[v]];
        }
    }

    void store(QuadricMesh<Q>& mesh, std::span<const Id> list) const {
        for (std::size_t v = 0; v < list.size(); ++v) {
            Ring& to = mesh.rings[list[v]];
            const Ring before = to;
            const TileVertex& vertex = vertices_[v];
            to.valence = vertex.valence;
            if (!vertex.live()) continue;
            to.x = vertex.x;
            to.y = vertex.y;
            to.fixed = vertex.fixed;
            for (int k = 0; k < vertex.valence; ++k) {
                const TileId n = rings_[v].neighbor[k];
                to.neighbor[k] = n < kElsewhere ? list[n] : before.neighbor[n - kElsewhere];
            }
            mesh.quadrics[list[v]] = quadrics_[v];
        }
    }

    void evaluate_all() {
        for (TileId v = 0; v < vertices_.size(); ++v) {
            const TileVertex& vertex = vertices_[v];
            if (!vertex.live() || vertex.locked) continue;
            TileId others[kNeighborRoom];
            int place[kNeighborRoom], count = 0;
            for (int k = 0; k < vertex.valence; ++k) {
                const TileId n = rings_[v].neighbor[k];
                others[count] = n;
                place[count] = k;
                count += n > v && !vertices_[n].locked;
            }
            float increments[kNeighborRoom];
            costs_.increments(v, others, count, increments);
            for (int k = 0; k < count; ++k) {
                const ShortCost cost = short_cost(costs_.cost(v, others[k], increments[k]));
                rings_[v].cost[place[k]] = cost;
                rings_[others[k]].cost[rings_[others[k]].find(v)] = cost;
            }
        }
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
    void follow(TileId start) {
        chain_.assign(1, start);
        while (!chain_.empty() && !stats_.reached(may_go_)) {
            const TileId v = chain_.back();
            const TileRing& ring = rings_[v];
            const ShortCost cost = least16(ring.cost);
            if (cost >= threshold_ || !vertices_[v].live()) {
                chain_.pop_back();
                continue;
            }
            const unsigned cheapest = match16(ring.cost, cost);
            const TileId before = chain_.size() > 1 ? chain_[chain_.size() - 2] : kNoTileId;
            if ((cheapest & match16(ring.neighbor, before)) == 0) {
                chain_.push_back(ring.neighbor[std::countr_zero(cheapest)]);
                continue;
            }
            chain_.pop_back();
            if (!try_collapse(before, v, cost)) continue;
            chain_.pop_back();
            merged_.push_back(before);
        }
    }

    // Merges j into i. Where that is not allowed the edge becomes more expensive, and it returns false.
    bool try_collapse(TileId i, TileId j, ShortCost cost) {
        MergedTileRing ring;
        if (!merge_rings(rings_, vertices_, i, j, ring)) return set_cost(i, j, kShortNever);
        const Q sum = merged(quadrics_[i], quadrics_[j]);
        Placement place = costs_.best_place(i, j, sum);
        if (!costs_.allowed(i, j, ring, place)) {
            place = costs_.fallback(i, j, ring, sum);
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

    bool set_cost(TileId i, TileId j, ShortCost cost) {
        rings_[i].cost[rings_[i].find(j)] = cost;
        rings_[j].cost[rings_[j].find(i)] = cost;
        return false;
    }

    // Gives i its new ring, names it i in the rings around, and evaluates its edges.
    void merge_into_rings(TileId i, TileId j, const MergedTileRing& ring) {
        TileRing& own = rings_[i];
        std::copy_n(ring.neighbor, TileRing::kRoom, own.neighbor);
        std::fill_n(own.cost, TileRing::kRoom, kNoEdge);
        TileId others[kNeighborRoom];
        std::copy_n(ring.neighbor, kNeighborRoom, others);
        float increments[kNeighborRoom];
        costs_.increments(i, others, ring.valence, increments);
        for (int k = 0; k < ring.valence; ++k) {
            const TileId n = ring.neighbor[k];
            TileVertex& vertex = vertices_[n];
            own.cost[k] = vertex.locked ? kShortNever : short_cost(costs_.cost(i, n, increments[k]));
            vertex.valence -= rings_[n].merge(i, j, own.cost[k], vertex.valence);
        }
    }

    const SimplifyRules& rules_;
    std::vector<TileRing> rings_;
    std::vector<TileVertex> vertices_;
    std::vector<Q> quadrics_;
    EdgeCosts<Q, std::vector<TileVertex>> costs_;
    std::vector<TileId> chain_;   // each is the cheapest to merge with for the one before
    std::vector<TileId> merged_;  // vertices that have merged since they were last looked at
    ShortCost threshold_ = 0;
    CollapseStats stats_, may_go_;
};

}  // namespace imgmesh
