// The files of a tile set: their names, and whether they are what was written.
#pragma once

#include <cstdint>
#include <string>

#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// A file of a tile set, as its writer left it.
struct TileFile {
    std::string path;  ///< below the set's folder, with '/'
    std::uint64_t bytes = 0;
    std::string sha256;  ///< in lower-case hex

    bool operator==(const TileFile&) const = default;
};

/// Returns "LEVEL/COLUMN_ROW", as in "0/3_5".
std::string tile_text(const TileName& tile);
/// The inverse. Throws Error(kBadArgument) for any other text, such as one with signs or leading zeros.
TileName tile_from_text(const std::string& text);

// The paths below the set's folder.
inline constexpr const char* kPlanFile = "plan.json";
inline constexpr const char* kIndexFile = "index.json";
inline constexpr const char* kTilesetFile = "tileset.json";  ///< of 3D Tiles, the root
/// The container of a tile: "0/3_5.glb".
std::string tile_container(const TileName& tile);
/// The record of a finished tile: "0/3_5.json".
std::string tile_record(const TileName& tile);
/// What viewers of 3D Tiles load: "view/0/3_5.glb".
std::string tile_view(const TileName& tile);

/// Joins a set's folder and a path below it.
std::string in_set(const std::string& folder, const std::string& path);

/// Makes the folders that the files of a level need. Throws Error(kIo).
void make_level_folders(const std::string& folder, int level);

/// Returns the facts of a file that is there. Throws Error(kIo) if it cannot be read.
TileFile file_facts(const std::string& folder, const std::string& path);

/// Returns whether a file has the bytes that its facts tell; reads all of it only if its length is right.
bool has_content(const std::string& folder, const TileFile& file);

}  // namespace imgmesh
