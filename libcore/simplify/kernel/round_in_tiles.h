// One round of collapses tile by tile over a mesh that is far from its goal: tiles side by side on all
// threads, each with the vertices that lie in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/simplify/kernel/edge_collapser.h"

namespace imgmesh {

/// A tiling of the plane by squares. It is moved from round to round so that seams do not stay where they
/// are.
struct RoundTiles {
    float side, shift;  // [px]
    int across, down;

    /// Each tile has about `vertices_a_tile` of the `live` vertices. Tiles of odd rounds lie half a tile
    /// beside those of even ones.
    RoundTiles(int width, int height, std::int64_t live, double vertices_a_tile, int round) {
        const double area =
            double(width) * height * vertices_a_tile / double(std::max<std::int64_t>(1, live));
        side = static_cast<float>(std::max(1.0, std::round(std::sqrt(area))));
        shift = round % 2 == 0 ? 0.0f : 0.5f * side;
        across = static_cast<int>((static_cast<float>(width) + shift) / side) + 1;
        down = static_cast<int>((static_cast<float>(height) + shift) / side) + 1;
    }
    int count() const { return across * down; }
    int of(const Ring& ring) const {
        const int x = static_cast<int>((ring.x + shift) / side),
                  y = static_cast<int>((ring.y + shift) / side);
        return std::clamp(y, 0, down - 1) * across + std::clamp(x, 0, across - 1);
    }
};

/// Collapses edges below `threshold` in every tile, but at most until `share_that_goes` of its vertices are
/// removed. Otherwise one tile could use up the whole budget. Edges of a vertex with a neighbour in another
/// tile stay; with a mask, edges of its boundary too. The result is the same for any number of threads.
template <class Q>
CollapseStats round_in_tiles(QuadricMesh<Q>& mesh, const SimplifyRules& rules, const RoundTiles& tiles,
                             float threshold, double share_that_goes) {
    RingMesh& rings = mesh.rings;
    const auto count = static_cast<int>(rings.size());
    constexpr int kGrain = 1 << 14;  // vertices that a thread takes at a time
    std::vector<Id> tile(rings.size());
    parallel_blocks(0, count, kGrain, [&](int begin, int end) {
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v)
            tile[v] = rings[v].live() ? static_cast<Id>(tiles.of(rings[v])) : kNone;
    });
    // Vertices by tile, ascending in each.
    std::vector<Id> first(static_cast<std::size_t>(tiles.count()) + 1, 0);
    for (const Id t : tile)
        if (t != kNone) ++first[t + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<Id> listed(first.back()), next(first.begin(), first.end() - 1);
    for (Id v = 0; v < tile.size(); ++v)
        if (tile[v] != kNone) listed[next[tile[v]]++] = v;
    parallel_blocks(0, count, kGrain, [&](int begin, int end) {
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v) {
            Ring& ring = rings[v];
            bool locked = rules.boundary != nullptr && ring.border();
            for (int k = 0; k < ring.valence; ++k) locked |= tile[ring.neighbor[k]] != tile[v];
            ring.locked = locked;
        }
    });
    std::vector<CollapseStats> stats(static_cast<std::size_t>(tiles.count()));
    parallel_blocks(0, tiles.count(), 1, [&](int begin, int end) {
        EdgeCollapser<Q> collapser(mesh, rules);
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t) {
            const Id* vertices = listed.data() + first[t];
            const std::size_t members = first[t + 1] - first[t];
            const auto may_go = static_cast<std::int64_t>(share_that_goes * double(members));
            stats[t] = collapser.run(members, [&](std::size_t n) { return vertices[n]; }, threshold,
                                     {.vertices = may_go, .faces = 2 * may_go});
        }
    });
    CollapseStats sum;
    for (const CollapseStats& part : stats) sum.add(part);
    parallel_blocks(0, count, kGrain, [&](int begin, int end) {
        for (auto v = static_cast<std::size_t>(begin); v < static_cast<std::size_t>(end); ++v)
            rings[v].locked = 0;
    });
    return sum;
}

}  // namespace imgmesh
