// Whether the tiles of a list cover their picture. Internal to this room.
#pragma once

#include "formats/picture/regions/tile_list.h"

namespace imgmesh {

/// Sets sizes that nobody has told, of files that cannot be read: to the next tile of the row and of the
/// column, or to the picture's end.
void guess_sizes(TileList& list);

/// Throws Error(kBadFile) for a tile that does not lie in the picture, and for pixels that are in none.
void check_coverage(const std::string& path, const TileList& list);

}  // namespace imgmesh
