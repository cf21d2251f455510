// Tile sets as the tools read them.
#pragma once

#include <string>

#include "formats/findings/limits.h"
#include "formats/tileset/tile_set.h"
#include "libcore/mesh/mesh_image.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// Returns what to say of the tiles of the set at `path` where a tool cannot take all of it.
std::string single_tiles(const std::string& path);

/// A set that a tool reads tile by tile.
struct SetInput {
    std::string path;  ///< as given
    std::string folder;
    TileSetIndex index;
    ContainerLimits limits;

    TileGrid grid() const { return index.plan.grid(); }
    /// Returns the tile, or no levels if there is none: it is missing, or its pixels are outside the mask.
    /// Throws Error(kBadFile) if it is not the file that the index tells, and as read_container() does.
    MeshImage read(const TileName& tile) const;
    /// Returns what all tiles have alike: that of the first tile of a level. Throws Error(kUnsupported) if
    /// the level has none.
    SourceInfo source(int level) const;
    /// Whether pixels of the picture are on no tile.
    bool has_gaps() const;
};

/// Throws Error(kBadArgument) for a level that the set does not have, and as read_index() does. Missing tiles
/// become a warning.
SetInput open_set(const std::string& path, int level, const ContainerLimits& limits, Context& context);

}  // namespace imgmesh
