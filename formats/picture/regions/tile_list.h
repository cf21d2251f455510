// A picture of many files. Internal to this room.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/picture/regions/region_reader.h"

namespace imgmesh {

struct ListedTile {
    std::string path;
    int x = 0, y = 0;            ///< in the picture, of its first pixel that is used
    int from_x = 0, from_y = 0;  ///< in the file, of that pixel
    int width = 0, height = 0;   ///< that are used; 0: all that the file has
    bool exact = true;           ///< the file has no other pixels
};

/// Where two files overlap, the later one in the list counts.
struct TileList {
    int width = 0, height = 0;  ///< 0: as far as the tiles reach
    std::vector<ListedTile> tiles;
};

/// Most files of a picture.
constexpr std::size_t kMostTiles = std::size_t{1} << 20;

/// Whether the file is a list: JSON by its first byte, a VRT by its extension.
bool is_json_list(const std::string& path);
bool is_vrt(const std::string& path);

/// Each throws Error: kIo if it cannot be read, kBadFile for broken lists, kUnsupported for VRTs that do more
/// than put files side by side. Files of relative names are in the list's folder.
TileList read_json_list(const std::string& path);
TileList read_vrt(const std::string& path);
/// The files of a folder that are named by their column and row, as in DeepZoom's "3_5.png", "name_3_5.png"
/// or "3-5.png"; others are not looked at. Columns and rows begin with the least number.
TileList list_folder(const std::string& path, const ReadImageOptions& options);

/// Sizes that are not given are those of the files' headers, or reach to the next tile for a file that cannot
/// be read. Throws Error(kBadFile) if pixels of the picture are in no tile, or no file can be read.
std::unique_ptr<RegionReader> open_list(const std::string& path, TileList list,
                                        const ReadImageOptions& options);

}  // namespace imgmesh
