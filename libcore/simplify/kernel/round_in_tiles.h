// One round of collapses tile by tile over a mesh that is far from its goal: tiles side by side on all
// threads, each with the vertices that lie in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/simplify/kernel/tile_collapser.h"

namespace imgmesh {

/// A tiling of the plane by squares. It is moved from round to round so that seams do not stay where they
/// are.
struct RoundTiles {
    int width, height;  // of the image
    float side, shift;  // [px]
    int across, down;

    /// Each tile has about `vertices_a_tile` of the `live` vertices. Tiles of odd rounds lie half a tile
    /// beside those of even ones.
    RoundTiles(int w, int h, std::int64_t live, double vertices_a_tile, int round) : width(w), height(h) {
        const double area =
            double(width) * height * vertices_a_tile / double(std::max<std::int64_t>(1, live));
        cut(static_cast<float>(std::max(1.0, std::round(std::sqrt(area)))), round % 2 != 0);
    }
    /// Tiles of half the side.
    RoundTiles finer() const {
        RoundTiles tiles = *this;
        tiles.cut(0.5f * side, shift > 0);
        return tiles;
    }
    int count() const { return across * down; }
    int of(const Ring& ring) const {
        const int x = static_cast<int>((ring.x + shift) / side),
                  y = static_cast<int>((ring.y + shift) / side);
        return std::clamp(y, 0, down - 1) * across + std::clamp(x, 0, across - 1);
    }

  private:
    void cut(float sides, bool shifted) {
        side = sides;
        shift = shifted ? 0.5f * side : 0.0f;
        across = static_cast<int>((static_cast<float>(width) + shift) / side) + 1;
        down = static_cast<int>((static_cast<float>(height) + shift) / side) + 1;
    }
};

/// The vertices of each tile, ascending.
struct TileLists {
    std::vector<Id> tile;    ///< of each vertex; kNone where it is removed
    std::vector<Id> first;   ///< of each tile in `vertex`, and the end
    std::vector<Id> vertex;  ///< tile by tile

    TileLists(const RingMesh& rings, const RoundTiles& tiles)
        : tile(rings.size()), first(static_cast<std::size_t>(tiles.count()) + 1, 0) {
        constexpr int kGrain = 1 << 14;  // vertices that a thread takes at a time
        parallel_blocks(0, static_cast<int>(rings.size()), kGrain, [&](int begin, int end) {
            for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v)
                tile[v] = rings[v].live() ? static_cast<Id>(tiles.of(rings[v])) : kNone;
        });
        for (const Id t : tile)
            if (t != kNone) ++first[t + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        vertex.resize(first.back());
        std::vector<Id> next(first.begin(), first.end() - 1);
        for (Id v = 0; v < tile.size(); ++v)
            if (tile[v] != kNone) vertex[next[tile[v]]++] = v;
    }

    std::span<const Id> of(std::size_t t) const {
        return std::span(vertex).subspan(first[t], first[t + 1] - first[t]);
    }
    /// Returns whether every tile's vertices can be numbered by a TileId.
    bool fit() const {
        for (std::size_t t = 0; t + 1 < first.size(); ++t)
            if (first[t + 1] - first[t] >= kNotInTile) return false;
        return true;
    }
};

/// Collapses edges below `threshold` in every tile, but at most until `share_that_goes` of its vertices are
/// removed. Otherwise one tile could use up the whole budget. Edges of a vertex with a neighbour in another
/// tile stay; with a mask, edges of its boundary too. Where a tile has too many vertices all are made
/// smaller. The result is the same for any number of threads.
template <class Q>
CollapseStats round_in_tiles(QuadricMesh<Q>& mesh, const SimplifyRules& rules, RoundTiles tiles,
                             float threshold, double share_that_goes) {
    TileLists lists(mesh.rings, tiles);
    while (!lists.fit()) {
        tiles = tiles.finer();
        lists = TileLists(mesh.rings, tiles);
    }
    std::vector<TileId> number(mesh.rings.size());
    std::vector<CollapseStats> stats(static_cast<std::size_t>(tiles.count()));
    parallel_blocks(0, tiles.count(), 1, [&](int begin, int end) {
        TileCollapser<Q> collapser(rules);
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
            const std::span<const Id> list = lists.of(t);
            for (std::size_t n = 0; n < list.size(); ++n) number[list[n]] = static_cast<TileId>(n);
            const auto number_here = [&](Id v) { return lists.tile[v] == t ? number[v] : kNoTileId; };
            const auto may_go = static_cast<std::int64_t>(share_that_goes * double(list.size()));
            collapser.load(mesh, list, number_here);
            stats[t] = collapser.run(threshold, {.vertices = may_go, .faces = 2 * may_go});
            collapser.store(mesh, list);
        }
    });
    CollapseStats sum;
    for (const CollapseStats& part : stats) sum.add(part);
    return sum;
}

}  // namespace imgmesh
