// The vertices of a tile while its edges collapse: copied with small numbers, and written back.
#pragma once

#include <span>
#include <vector>

#include "libcore/simplify/kernel/grid_costs.h"
#include "libcore/simplify/kernel/quadric_mesh.h"
#include "libcore/simplify/kernel/tile_rings.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"

namespace imgmesh {

/// Whether a pixel of a rectangle has neighbours outside of it.
inline bool on_rim(const PixelRect& rect, int x, int y) {
    return x == rect.left || x + 1 == rect.right || y == rect.top || y + 1 == rect.bottom;
}

/// Keeps its memory from tile to tile.
template <class Q>
struct TileContent {
    std::vector<TileRing> rings;
    std::vector<TileVertex> vertices;
    std::vector<Q> quadrics;

    /// Copies the vertices of `list`. Vertices with a neighbour elsewhere are locked, and so are those on the
    /// boundary of a masked image. Edges have no costs yet.
    ///
    /// number(v)   the place of vertex v in the list, kNoTileId where it is not in it
    /// masked      whether borders are the boundary of a masked image
    template <class Number>
    void copy(const QuadricMesh<Q>& mesh, std::span<const Id> list, const Number& number, bool masked) {
        rings.resize(list.size());
        vertices.resize(list.size());
        quadrics.resize(list.size());
        for (TileId v = 0; v < list.size(); ++v) {
            copy_ring(v, mesh.rings[list[v]], number, masked);
            quadrics[v] = mesh.quadrics[list[v]];
        }
    }

    /// The same for the pixels of a rectangle, row by row, for colours without a mask. Edges of pixels that
    /// are not on the rim have their costs.
    ///
    /// gradients   reach to the neighbours of the rectangle
    void copy(const GridMesh& grid, const PixelRect& rect, const FeaturePatch& gradients, float lambda) {
        const auto w = static_cast<std::size_t>(rect.width()),
                   count = w * static_cast<std::size_t>(rect.height());
        rings.resize(count);
        vertices.resize(count);
        quadrics.resize(count);
        vertex_quadrics(grid, gradients, lambda, rect, quadrics.data());
        grid_costs(grid, rect, quadrics.data(), inner_costs_);
        TileId v = 0;
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x, ++v)
                if (on_rim(rect, x, y))
                    copy_rim(grid, rect, v, x, y);
                else
                    copy_inner(grid, v, static_cast<TileId>(w), x, y);
    }

    /// Writes the vertices back to where they come from.
    void store(QuadricMesh<Q>& mesh, std::span<const Id> list) const {
        for (std::size_t v = 0; v < list.size(); ++v) {
            Ring& to = mesh.rings[list[v]];
            const TileVertex& vertex = vertices[v];
            if (vertex.live()) {
                const Ring before = to;
                to.x = vertex.x;
                to.y = vertex.y;
                to.fixed = vertex.fixed;
                for (int k = 0; k < vertex.valence; ++k) {
                    const TileId n = rings[v].neighbor[k];
                    to.neighbor[k] = n < kNotInTile ? list[n] : before.neighbor[n - kNotInTile];
                }
                mesh.quadrics[list[v]] = quadrics[v];
            }
            to.valence = vertex.valence;
        }
    }

  private:
    template <class Number>
    void copy_ring(TileId v, const Ring& from, const Number& number, bool masked) {
        TileRing& ring = rings[v];
        fill16_from(ring.neighbor, 0, kNoTileId);
        fill16_from(ring.cost, 0, kNoEdge);
        bool locked = masked && from.border();
        for (int k = 0; k < from.valence; ++k) {
            const TileId n = number(from.neighbor[k]);
            locked |= n == kNoTileId;
            ring.neighbor[k] = n == kNoTileId ? static_cast<TileId>(kNotInTile + k) : n;
            ring.cost[k] = kShortNever;
        }
        vertices[v] = {from.x, from.y, from.valence, from.fixed, locked || from.locked};
    }
    // All neighbours of pixel (x, y) are in the rectangle: in the order of inner_ring().
    void copy_inner(const GridMesh& grid, TileId v, TileId stride, int x, int y) {
        vertices[v] = {grid.origin_x + static_cast<float>(x), grid.origin_y + static_cast<float>(y), 0, 0,
                       false};
        TileRing& ring = rings[v];
        fill16_from(ring.neighbor, 0, kNoTileId);
        fill16_from(ring.cost, 0, kNoEdge);
        const std::size_t here = v, north = here - stride, south = here + stride;
        const GridCosts& costs = inner_costs_;
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
        vertices[v].valence = static_cast<std::uint8_t>(k);
    }
    void copy_rim(const GridMesh& grid, const PixelRect& rect, TileId v, int x, int y) {
        const auto w = static_cast<Id>(grid.feature.width);
        copy_ring(
            v, grid_ring(grid, x, y),
            [&](Id n) {
                const int nx = static_cast<int>(n % w), ny = static_cast<int>(n / w);
                const bool here = nx >= rect.left && nx < rect.right && ny >= rect.top && ny < rect.bottom;
                return here ? static_cast<TileId>((ny - rect.top) * rect.width() + nx - rect.left)
                            : kNoTileId;
            },
            false);
    }

    GridCosts inner_costs_;
};

}  // namespace imgmesh
