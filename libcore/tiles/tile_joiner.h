// Tiles of one level as one mesh.
#pragma once

#include <map>
#include <utility>

#include "libcore/mesh/base_mesh.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// Joins tiles one by one, so that none of them must be kept. Vertices on sides that tiles share become one,
/// as neighbours have the same ones there.
class TileJoiner {
  public:
    explicit TileJoiner(const TileGrid& grid) : grid_(grid) {}

    /// Adds a tile in units of its level (tile_units.h). Throws Error(kBadFile) if it has other features than
    /// the first one.
    void add(const TileName& tile, const BaseMesh& mesh);
    /// Returns the whole, in units of the level from the picture's top-left pixel.
    BaseMesh take() { return std::move(mesh_); }

  private:
    TileGrid grid_;
    BaseMesh mesh_;
    std::map<std::pair<float, float>, Id> on_sides_;
};

}  // namespace imgmesh
