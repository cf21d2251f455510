// A tile of a coarser level, from the files of four tiles of the level before.
#pragma once

#include <optional>
#include <string>

#include "libcore/mesh/mesh_image.h"
#include "libcore/simplify/simplify_params.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// Returns the tile, or nothing if there is nothing on it: its children are missing, or outside the mask.
/// Throws as read_record() and read_meshes() do.
std::optional<MeshImage> read_coarse_tile(const std::string& folder, const TileGrid& grid,
                                          const TileName& tile, const SimplifyParams& params);

}  // namespace imgmesh
