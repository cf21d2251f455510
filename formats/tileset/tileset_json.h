// A tile set as 3D Tiles 1.1, which viewers of maps stream.
#pragma once

#include <string>
#include <vector>

#include "formats/tileset/tile_set.h"

namespace imgmesh {

/// Returns the mean distance of vertices of level 0 [pixels]; 1 if there are none.
double mean_spacing(const TileSetIndex& index);

/// A file below the set's folder.
struct TextFile {
    std::string path;
    std::string text;
};

/// Returns kTilesetFile and the external tilesets that it refers to, view/LEVEL/COLUMN_ROW.json: every fourth
/// level begins new ones, so that no file has more than some hundred tiles.
///
/// Tiles of level k replace their parent; their geometricError is 2^k mean_spacing(), that of level 0 is 0. A
/// tile without a file tile_view() has no content. In the frame of the tileset x is to the right, y up and z
/// towards the viewer, one unit is a pixel of level 0, and the centre of the top-left pixel is the origin.
/// The member "extras" of the first file tells width, height, tile, levels and spacing. The same index gives
/// the same text.
std::vector<TextFile> tileset_files(const TileSetIndex& index);

/// Writes them. Throws Error(kIo).
void write_tileset(const std::string& folder, const TileSetIndex& index);

}  // namespace imgmesh
