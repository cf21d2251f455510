// The first part of the collapse, which removes most vertices: small tiles of the image by themselves. The
// dense mesh, of which they are parts, never exists as a whole.
//
// Steps: (1) some tiles show the threshold that leaves the wanted share of the vertices; (2) each tile is
// made, collapsed below that threshold and reduced to its survivors; (3) the survivors of all tiles become
// one mesh.
#pragma once

#include <algorithm>
#include <atomic>
#include <deque>
#include <limits>
#include <numeric>
#include <thread>
#include <utility>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/simplify/kernel/start_tile.h"
#include "libcore/simplify/kernel/tile_collapser.h"

namespace imgmesh {

// The threshold rises by this factor from one round of tiles to the next. With 4 the error rises by 0.2 %
// (docs/decisions/0019-collapse-in-tiles.md).
inline constexpr float kTileWindow = 2.0f;

// Tiles that one thread takes at a time, in the same memory: enough to make its memory serve
// again, few enough to keep all threads busy to the end of an image of 1000 x 1000, which has 256.
inline constexpr int kStartTilesPerBlock = 4;
// Tiles whose survivors are kept one by one before they are put together. Recheck by the peak memory of
// `imgmesh-build --preset fast` on a large image.
inline constexpr int kStartTilesAtATime = 512;
// The threshold is found on one tile in so many, at most on kMostTried: they are collapsed twice, and the
// threshold is wanted to no more than kTileWindow.
inline constexpr int kTriedOneIn = 32, kMostTried = 16;
// Room for survivors, as a multiple of those expected: the threshold is rather too low than too high. Room
// that is not touched costs nothing, while a vector that grows is copied.
inline constexpr double kRoomForSurvivors = 1.3;

/// Returns the threshold that would leave `share` of the vertices, within a factor of kTileWindow and rather
/// too low. It is found on some of the tiles.
template <class Q>
float start_threshold(const GridMesh& grid, const SimplifyRules& rules, double share);

/// Collapses edges below `threshold` in every tile of the grid, but at most until `share_that_goes` of its
/// vertices are removed. Vertices next to another tile stay, and so do those on the boundary of a masked
/// image.
///
/// share     the share of the vertices that is expected to remain
/// left      out: the survivors, tile by tile, in the grid's order within each
/// progress  gets the number of vertices removed so far
template <class Q, class Progress>
CollapseStats start_in_tiles(const GridMesh& grid, const SimplifyRules& rules, float threshold, double share,
                             double share_that_goes, QuadricMesh<Q>& left, const Progress& progress);

namespace start_tiles {

// Among the neighbours in what survivors() returns: a neighbour in another tile, by its pixel.
inline constexpr Id kElsewhere = 1u << 31;

// Returns the remaining vertices, numbered from 0. Writes these numbers to number[vertex].
template <class Q>
QuadricMesh<Q> survivors(const TileMesh<Q>& tile, std::vector<Id>& number) {
    const QuadricMesh<Q>& mesh = tile.mesh;
    const std::vector<Id> live = live_list(mesh.rings);
    for (Id n = 0; n < live.size(); ++n) number[mesh.pixel[live[n]]] = n;
    QuadricMesh<Q> out;
    out.rings.reserve(live.size());
    out.quadrics.reserve(live.size());
    out.pixel.reserve(live.size());
    for (const Id v : live) {
        Ring ring = mesh.rings[v];
        for (int k = 0; k < ring.valence; ++k)
            if (Id& n = ring.neighbor[k]; n < tile.own)
                n = number[mesh.pixel[n]];
            else
                n = mesh.pixel[n] | kElsewhere;
        ring.version = 0;
        ring.locked = 0;
        out.rings.push_back(ring);
        out.quadrics.push_back(mesh.quadrics[v]);
        out.pixel.push_back(mesh.pixel[v]);
    }
    return out;
}

// The same of a tile that was loaded from the grid.
template <class Q>
QuadricMesh<Q> survivors(const TileCollapser<Q>& collapser, const GridMesh& grid, const PixelRect& rect,
                         std::vector<Id>& number) {
    const std::vector<TileVertex>& vertices = collapser.vertices();
    const auto width = static_cast<Id>(rect.width());
    const auto x_of = [&](Id v) { return rect.left + static_cast<int>(v % width); };
    const auto y_of = [&](Id v) { return rect.top + static_cast<int>(v / width); };
    std::vector<Id> place(vertices.size());
    QuadricMesh<Q> out;
    for (Id v = 0; v < vertices.size(); ++v) {
        if (!vertices[v].live()) continue;
        place[v] = static_cast<Id>(out.pixel.size());
        const Id pixel = as_id(grid.feature.index(x_of(v), y_of(v)));
        number[pixel] = place[v];
        out.pixel.push_back(pixel);
    }
    out.rings.reserve(out.pixel.size());
    out.quadrics.reserve(out.pixel.size());
    for (Id v = 0; v < vertices.size(); ++v) {
        const TileVertex& vertex = vertices[v];
        if (!vertex.live()) continue;
        Ring& ring = out.rings.emplace_back();
        if (vertex.locked) ring = grid_ring(grid, x_of(v), y_of(v));
        const Ring before = ring;
        for (int k = 0; k < vertex.valence; ++k) {
            const TileId n = collapser.rings()[v].neighbor[k];
            ring.neighbor[k] = n < kNotInTile ? place[n] : before.neighbor[n - kNotInTile] | kElsewhere;
        }
        ring.x = vertex.x;
        ring.y = vertex.y;
        ring.valence = vertex.valence;
        ring.fixed = vertex.fixed;
        out.quadrics.push_back(collapser.quadrics()[v]);
    }
    return out;
}

// A start tile and what collapses it: from load() to store() its vertices are there.
template <class Q>
struct StartCollapse {
    static_assert(4 * kStartTile * kStartTile < kNotInTile);  // a pixel has four vertices at most

    TileMesh<Q> tile;
    TileCollapser<Q> collapser;
    std::vector<Id> all;  // of the tile's own vertices
    bool direct = false;  // loaded from the grid: the tile has no mesh

    explicit StartCollapse(const SimplifyRules& rules) : collapser(rules) {}

    void fill(const GridMesh& grid, const SimplifyParams& params, const PixelRect& rect) {
        if constexpr (std::is_same_v<Q, Quadric<3>>) {
            direct = grid.mask.empty() && !params.rebuild_quadrics;
            if (direct) {
                collapser.load_grid(grid, rect, smoothed_patch(grid, params.smoothing, rect));
                tile.own = collapser.vertices().size();
                tile.live = static_cast<std::int64_t>(tile.own);
                return;
            }
        }
        fill_tile(grid, params, rect, tile);
        all.resize(tile.own);
        std::iota(all.begin(), all.end(), Id{0});
        load();
    }
    auto number() const {
        return [this](Id v) { return v < tile.own ? static_cast<TileId>(v) : kNoTileId; };
    }
    void load() { collapser.load(tile.mesh, all, number()); }
    void store() { collapser.store(tile.mesh, all); }
    QuadricMesh<Q> survivors(const GridMesh& grid, const PixelRect& rect, std::vector<Id>& numbers) {
        if (direct) return start_tiles::survivors(collapser, grid, rect, numbers);
        store();
        return start_tiles::survivors(tile, numbers);
    }

    // Collapses the tile's edges below `threshold`. If requested, quadrics are rebuilt whenever its vertices
    // have halved. Neighbours in other tiles are locked too, so their state is known then.
    CollapseStats run(const SimplifyParams& params, float threshold, std::int64_t may_go) {
        CollapseStats sum;
        for (;;) {
            std::int64_t part_may = may_go - sum.vertices;
            if (params.rebuild_quadrics) part_may = std::min(part_may, tile.live - tile.halved);
            const CollapseStats part =
                collapser.run(threshold, {.vertices = part_may, .faces = kAllMayGo.faces});
            // Edges put off while quadrics were old may be cheaper now.
            sum.postponed = kNever;
            sum.add(part);
            tile.live -= part.vertices + part.due;
            const bool halved = params.rebuild_quadrics && part.vertices > 0 && tile.live <= tile.halved;
            if (!halved || sum.vertices >= may_go) return sum;
            store();
            const std::vector<Q> rebuilt = rebuilt_quadrics(tile.mesh.rings, tile.mesh.quadrics, params);
            std::copy_n(rebuilt.begin(), tile.own, tile.mesh.quadrics.begin());  // ghosts stay as they are
            tile.halved = tile.live / 2;
            load();
        }
    }
};

template <class T>
void append(std::vector<T>& to, const std::vector<T>& part) {
    to.insert(to.end(), part.begin(), part.end());
}

// Names neighbours by their place in the whole: first[t] is where the vertices of tile t begin.
inline void join(const StartTiles& tiles, const std::vector<Id>& first, const std::vector<Id>& number,
                 RingMesh& rings) {
    parallel_blocks(0, tiles.count(), kStartTilesPerBlock, [&](int begin, int end) {
        for (auto t = static_cast<std::size_t>(begin); t < static_cast<std::size_t>(end); ++t)
            for (Id v = first[t]; v < first[t + 1]; ++v)
                for (int k = 0; k < rings[v].valence; ++k) {
                    Id& n = rings[v].neighbor[k];
                    const Id vertex = n & ~kElsewhere;
                    n = n & kElsewhere ? first[static_cast<std::size_t>(tiles.of(vertex))] + number[vertex]
                                       : first[t] + n;
                }
    });
}

// Tiles all over the image.
inline std::vector<int> some_tiles(const StartTiles& tiles) {
    const int count = std::clamp(tiles.count() / kTriedOneIn, 1, kMostTried);
    std::vector<int> some;
    for (int n = 0; n < count; ++n) some.push_back((2 * n + 1) * tiles.count() / (2 * count));
    return some;
}

// Of the first edge of each vertex that may collapse.
template <class Q>
float median_cost(const TileCollapser<Q>& collapser) {
    std::vector<float> costs;
    for (std::size_t v = 0; v < collapser.vertices().size(); ++v)
        if (const ShortCost cost = collapser.rings()[v].cost[0]; cost < kShortNever)
            costs.push_back(least_cost(cost));
    return costs.empty() ? 0 : median(std::move(costs));
}

}  // namespace start_tiles

template <class Q>
float start_threshold(const GridMesh& grid, const SimplifyRules& rules, double share) {
    using namespace start_tiles;
    const StartTiles tiles(grid);
    const std::vector<int> some = some_tiles(tiles);
    std::deque<StartCollapse<Q>> parts;
    for (std::size_t n = 0; n < some.size(); ++n) parts.emplace_back(rules);
    std::vector<float> medians(some.size());
    const auto each = [&](const auto& body) {
        parallel_blocks(0, static_cast<int>(some.size()), 1,
                        [&](int n, int) { body(static_cast<std::size_t>(n)); });
    };
    each([&](std::size_t n) {
        parts[n].fill(grid, rules.params, tiles.rect(some[n]));
        medians[n] = median_cost(parts[n].collapser);
    });
    std::int64_t all = 0, removed = 0;
    for (const StartCollapse<Q>& part : parts) all += part.tile.live - part.tile.boundary;
    float threshold = std::max(median(medians), std::numeric_limits<float>::min());
    for (float next = threshold;; next *= kTileWindow) {
        std::vector<CollapseStats> stats(some.size());
        each([&](std::size_t n) { stats[n] = parts[n].run(rules.params, next, kAllMayGo.vertices); });
        CollapseStats sum;
        for (const CollapseStats& part : stats) sum.add(part);
        removed += sum.vertices;
        if (static_cast<double>(removed) > (1 - share) * static_cast<double>(all)) return threshold;
        threshold = next;
        if (sum.postponed == kNever) return threshold;
        while (next < sum.postponed && sum.vertices == 0) next *= kTileWindow;
    }
}

template <class Q, class Progress>
CollapseStats start_in_tiles(const GridMesh& grid, const SimplifyRules& rules, float threshold, double share,
                             double share_that_goes, QuadricMesh<Q>& left, const Progress& progress) {
    using namespace start_tiles;
    const StartTiles tiles(grid);
    const auto expected =
        static_cast<std::size_t>(kRoomForSurvivors * share * static_cast<double>(grid.vertex_count()));
    left.rings.reserve(expected);
    left.quadrics.reserve(expected);
    left.pixel.reserve(expected);
    std::vector<Id> first(static_cast<std::size_t>(tiles.count()) + 1, 0);
    std::vector<Id> number = parallel_vector<Id>(grid.vertex_count());
    CollapseStats sum;
    std::atomic<std::int64_t> removed = 0;
    const std::thread::id caller = std::this_thread::get_id();
    // Some tiles at a time, so that the memory of their parts is used again.
    for (int begin = 0; begin < tiles.count(); begin += kStartTilesAtATime) {
        const int end = std::min(begin + kStartTilesAtATime, tiles.count());
        std::vector<QuadricMesh<Q>> parts(static_cast<std::size_t>(end - begin));
        std::vector<CollapseStats> stats(parts.size());
        parallel_blocks(begin, end, kStartTilesPerBlock, [&](int from, int to) {
            StartCollapse<Q> part(rules);
            const TileMesh<Q>& tile = part.tile;
            for (int t = from; t < to; ++t) {
                const auto n = static_cast<std::size_t>(t - begin);
                part.fill(grid, rules.params, tiles.rect(t));
                const auto may_go = static_cast<std::int64_t>(share_that_goes *
                                                              static_cast<double>(tile.live - tile.boundary));
                stats[n] = part.run(rules.params, threshold, may_go);
                parts[n] = part.survivors(grid, tiles.rect(t), number);
                removed += stats[n].vertices;
            }
            if (std::this_thread::get_id() == caller) progress(removed);
        });
        for (std::size_t n = 0; n < parts.size(); ++n) {
            sum.add(stats[n]);
            append(left.rings, parts[n].rings);
            append(left.quadrics, parts[n].quadrics);
            append(left.pixel, parts[n].pixel);
            first[static_cast<std::size_t>(begin) + n + 1] = static_cast<Id>(left.rings.size());
        }
    }
    join(tiles, first, number, left.rings);
    return sum;
}

}  // namespace imgmesh
