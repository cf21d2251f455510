// What the work on tiles takes, so that too much is told before and not by the system.
#pragma once

#include "libcore/tiles/tile_grid.h"
#include "tools/tiles/tile_plan.h"

namespace imgmesh {

/// Returns what the work on a tile takes at most [bytes].
///
/// pixels   of the tile
/// density  vertices for each of its pixels
double tile_bytes(double pixels, double density);

/// Where only an error is wanted: throws Error(kUnsupported) if the tile would keep so many vertices that the
/// work on them takes more memory than there is. Estimated from parts of the tile.
void check_density(const Image& tile, const PlannedTileSet& planned, std::uint64_t max_memory);

/// Returns what a user should know of a tile with so many vertices; "" if it is nothing.
std::string density_warning(const TileRecord& record, const PlannedTileSet& planned);

}  // namespace imgmesh
