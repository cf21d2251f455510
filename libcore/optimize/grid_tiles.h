// Parts of a mesh that an optimisation may change at the same time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/base/types.h"

namespace imgmesh {

/// Consecutive vertices are a tile; numbered along a curve that fills the plane, they lie together. Tiles are
/// in classes. While a class has its turn, each of its tiles claims its own vertices and those of all tiles
/// that share a face with it, and no vertex is claimed twice. So steps that read and write only what belongs
/// to claimed vertices may run for all tiles of a class at the same time, and the outcome is that of one
/// after the other, even if flips make other faces meanwhile.
class GridTiles {
  public:
    static constexpr Id kTileVertices = 96;

    /// Faces with kNone as corners are left out.
    GridTiles(std::span<const Face> faces, std::size_t vertices);

    struct Turn {
        Id tile, first, last;  ///< its vertices: first <= v < last
        std::span<const Id> claims;

        bool claims_vertex(Id v) const { return claims[v / kTileVertices] == tile; }
    };

    /// Calls work(turn) once for each tile, on all threads for those of a class, and after_class() after
    /// each.
    template <class Work, class AfterClass>
    void for_each(Work&& work, AfterClass&& after_class) const {
        for (const Class& turns : classes_) {
            parallel_blocks(0, static_cast<int>(turns.tiles.size()), 1, [&](int begin, int end) {
                for (int k = begin; k < end; ++k) {
                    const Id tile = turns.tiles[static_cast<std::size_t>(k)];
                    work(Turn{tile, tile * kTileVertices, std::min((tile + 1) * kTileVertices, vertices_),
                              turns.claims});
                }
            });
            after_class();
        }
    }

    template <class Work>
    void for_each(Work&& work) const {
        for_each(work, [] {});
    }

    std::size_t size() const { return tiles_; }

  private:
    struct Class {
        std::vector<Id> tiles, claims;  // claims: the claimant of each tile, or kNone
    };

    Id vertices_, tiles_;
    std::vector<Class> classes_;
};

}  // namespace imgmesh
