// The dense mesh of one small tile of the image. The collapse begins with such tiles.
#pragma once

#include <algorithm>
#include <vector>

#include "libcore/mesh/masked_rings.h"
#include "libcore/simplify/kernel/quadric_mesh.h"

namespace imgmesh {

/// Side of a tile [px]. Its rings and quadrics take 590 KB (tile_collapser.h), which stays in a core's own
/// cache. Recheck by the time of `imgmesh-build --preset fast` on an image of 2048 x 2048.
inline constexpr int kStartTile = 64;

/// The square tiles of a grid, the last of each row and column perhaps smaller.
struct StartTiles {
    explicit StartTiles(const GridMesh& g) : grid(g) {}

    const GridMesh& grid;
    int across = (grid.feature.width + kStartTile - 1) / kStartTile,
        down = (grid.feature.height + kStartTile - 1) / kStartTile;

    int count() const { return across * down; }
    int of(Id vertex) const {
        const Id pixel = grid.pixel_of(vertex), w = static_cast<Id>(grid.feature.width);
        return static_cast<int>(pixel / w) / kStartTile * across + static_cast<int>(pixel % w) / kStartTile;
    }
    PixelRect rect(int tile) const {
        const int left = tile % across * kStartTile, top = tile / across * kStartTile;
        return {left, top, std::min(left + kStartTile, grid.feature.width),
                std::min(top + kStartTile, grid.feature.height)};
    }
};

/// A tile while it collapses. A neighbour in another tile is a *ghost*: it has a place and features, but no
/// ring of its own. Vertices with a ghost among their neighbours are locked, and so are those on the boundary
/// of a masked image.
template <class Q>
struct TileMesh {
    QuadricMesh<Q> mesh;        ///< the tile's own vertices row by row, then ghosts
    std::size_t own = 0;        ///< so many
    std::int64_t live = 0;      ///< of them
    std::int64_t boundary = 0;  ///< of them on the boundary of a masked image
    std::int64_t halved = 0;    ///< vertices at which quadrics are to be rebuilt next
};

namespace start_tile {

inline bool contains(const PixelRect& rect, int x, int y) {
    return x >= rect.left && x < rect.right && y >= rect.top && y < rect.bottom;
}

// Renumbers the neighbours of a ring, which are named by their numbers in the grid mesh: those in the tile
// get local(number, x, y), the others become new ghosts.
template <class Q, class Local>
void localize(const GridMesh& grid, const PixelRect& rect, QuadricMesh<Q>& mesh, Ring& ring,
              const Local& local) {
    const Id w = static_cast<Id>(grid.feature.width);
    for (int k = 0; k < ring.valence; ++k) {
        Id& n = ring.neighbor[k];
        const Id pixel = grid.pixel_of(n);
        const int x = static_cast<int>(pixel % w), y = static_cast<int>(pixel / w);
        if (contains(rect, x, y)) {
            n = local(n, x, y);
            continue;
        }
        ring.locked = 1;
        mesh.pixel.push_back(n);
        n = static_cast<Id>(mesh.pixel.size() - 1);
    }
}

// Rings and quadrics of what localize() has added to mesh.pixel.
template <class Q>
void add_ghosts(const GridMesh& grid, QuadricMesh<Q>& mesh) {
    const std::size_t own = mesh.rings.size();
    mesh.rings.resize(mesh.pixel.size());
    mesh.quadrics.resize(mesh.pixel.size());
    for (std::size_t v = own; v < mesh.pixel.size(); ++v) {
        const Id number = mesh.pixel[v];
        const Vec2f at = vertex_place(grid, number);
        mesh.quadrics[v].px = mesh.rings[v].x = at.x();
        mesh.quadrics[v].py = mesh.rings[v].y = at.y();
        std::copy_n(grid.feature.pixel(number), Q::kChannels, mesh.quadrics[v].s);
    }
}

// Where whole() holds.
template <class Q>
void fill_whole(const GridMesh& grid, const FeaturePatch& gradients, float lambda, const PixelRect& rect,
                QuadricMesh<Q>& mesh) {
    const Id w = static_cast<Id>(grid.feature.width), stride = static_cast<Id>(rect.width());
    const std::size_t own = stride * static_cast<std::size_t>(rect.height());
    // With ghosts: each pixel of a side has at most three neighbours beyond it.
    const std::size_t most = own + 3 * 2 * (stride + static_cast<std::size_t>(rect.height()));
    mesh.rings.reserve(most);
    mesh.quadrics.reserve(most);
    mesh.rings.resize(own);
    mesh.pixel.resize(own);
    mesh.quadrics.resize(own);
    vertex_quadrics(grid, gradients, lambda, rect, mesh.quadrics.data());
    const auto local = [&](Id, int x, int y) {
        return static_cast<Id>(y - rect.top) * stride + static_cast<Id>(x - rect.left);
    };
    Id v = 0;
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x, ++v) {
            mesh.pixel[v] = static_cast<Id>(y) * w + static_cast<Id>(x);
            if (x > rect.left && x + 1 < rect.right && y > rect.top && y + 1 < rect.bottom) {
                mesh.rings[v] = inner_ring(grid, x, y, v, stride);
            } else {
                mesh.rings[v] = grid_ring(grid, x, y);
                localize(grid, rect, mesh, mesh.rings[v], local);
            }
        }
    add_ghosts(grid, mesh);
}

template <class Q>
void fill_masked(const GridMesh& grid, const FeaturePatch& gradients, float lambda, const PixelRect& rect,
                 QuadricMesh<Q>& mesh) {
    mesh.rings.clear();
    mesh.pixel.clear();
    Id first[kStartTile * kStartTile];  // of a pixel's vertices
    const auto place = [&](int x, int y) { return (y - rect.top) * kStartTile + x - rect.left; };
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x) {
            first[place(x, y)] = static_cast<Id>(mesh.rings.size());
            if (!grid.mask.at(x, y)) continue;
            const PixelRings pixel = masked_pixel_rings(grid, x, y);
            for (std::size_t n = 0; n < pixel.count; ++n) {
                mesh.rings.push_back(pixel.ring[n]);
                mesh.pixel.push_back(pixel.vertex[n]);
            }
        }
    for (Ring& ring : mesh.rings) {
        localize(grid, rect, mesh, ring, [&](Id number, int x, int y) {
            Id v = first[place(x, y)];
            while (mesh.pixel[v] != number) ++v;
            return v;
        });
        ring.locked |= ring.border();
    }
    const std::size_t own = mesh.rings.size();
    add_ghosts(grid, mesh);
    std::vector<Q> quadrics = vertex_quadrics<Q::kChannels>(grid, mesh.rings, mesh.pixel, gradients, lambda);
    std::copy_n(quadrics.begin(), own, mesh.quadrics.begin());
}

// Whether all pixels are inside, and those around the tile on which the rings at its sides depend: a
// neighbour has copies, or none, by the pixels around it.
inline bool whole(const GridMesh& grid, const PixelRect& rect) {
    constexpr int kReach = 2;
    if (grid.mask.empty()) return true;
    for (int y = rect.top - kReach; y < rect.bottom + kReach; ++y)
        for (int x = rect.left - kReach; x < rect.right + kReach; ++x)
            if (!grid.mask.at(x, y)) return false;
    return true;
}

inline bool outside(const GridMesh& grid, const PixelRect& rect) {
    if (grid.mask.empty()) return false;
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x)
            if (grid.mask.at(x, y)) return false;
    return true;
}

}  // namespace start_tile

/// Makes `tile` the part of the dense mesh that has the vertices of the pixels in `rect`.
template <class Q>
void fill_tile(const GridMesh& grid, const SimplifyParams& params, const PixelRect& rect, TileMesh<Q>& tile) {
    if (start_tile::outside(grid, rect)) {
        tile.mesh.rings.clear();
        tile.mesh.quadrics.clear();
        tile.mesh.pixel.clear();
    } else {
        const FeaturePatch gradients = smoothed_patch(grid, params.smoothing, rect);
        const float lambda = params.geometry_weight;
        if (start_tile::whole(grid, rect))
            start_tile::fill_whole(grid, gradients, lambda, rect, tile.mesh);
        else
            start_tile::fill_masked(grid, gradients, lambda, rect, tile.mesh);
    }
    const auto live = [](const Ring& ring) { return ring.live(); };
    const auto end = std::find_if_not(tile.mesh.rings.begin(), tile.mesh.rings.end(), live);
    tile.own = static_cast<std::size_t>(end - tile.mesh.rings.begin());
    tile.live = end - tile.mesh.rings.begin();
    tile.boundary = grid.mask.empty() ? 0 : std::count_if(tile.mesh.rings.begin(), end, [](const Ring& ring) {
        return ring.border();
    });
    tile.halved = tile.live / 2;
}

}  // namespace imgmesh
