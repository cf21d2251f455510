// What is known of a tile set: its plan, the records of its finished tiles, its index. Their files are
// described by schemas/imgmesh-tileset.*.schema.json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "formats/tileset/tile_files.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// The picture of which a set is made, and how to tell whether it is still the same.
struct TileSource {
    std::string path;         ///< as given
    std::uint64_t bytes = 0;  ///< of the file, or of all files of a folder
    /// When it was changed last [ns since 1970], or what else tells its content: any text; may be empty.
    std::string stamp;
};

/// What is decided before the first tile is made, and all that decides what the tiles are.
struct TileSetPlan {
    std::string generator;  ///< "imgmesh-build 0.1.0"
    TileSource source;
    int width = 0, height = 0;  ///< of the picture [pixels]
    int tile = 0;               ///< TileGrid's step
    /// Of the tiles, each name once, with the values as text; a reader gets them sorted by name.
    std::vector<std::pair<std::string, std::string>> parameters;
    double density = 0;               ///< the wanted one [vertices in 100 pixels]; 0 where only an error is
    std::optional<double> threshold;  ///< of a collapse's increment; nothing where a first pass finds it

    TileGrid grid() const { return {width, height, tile}; }
};

/// Returns the hash of everything in a plan but the source's path: a tile with another key is made anew.
std::string plan_key(const TileSetPlan& plan);

/// What became of a tile: written after its files, so where a record is, its files are complete.
struct TileRecord {
    TileName tile;
    std::string key;  ///< plan_key()
    /// Its container first; none if all of its pixels are outside the mask, or if it is missing.
    std::vector<TileFile> files;
    std::int64_t vertices = 0;
    /// Without those on a right or bottom side that another tile shares: the sum of a level's tiles is the
    /// number of its different vertices.
    std::int64_t own_vertices = 0;
    std::int64_t faces = 0;
    /// Of level 0: pixels that the tile owns (TileGrid::own_rect) inside the mask, and the sums of their
    /// squared errors through the pixel map and of the mesh alone, so that those of the whole set are exact
    /// sums. [L*u*v*^2, or features with their weights]
    std::int64_t pixels = 0;
    double map_squares = 0, gouraud_squares = 0;
    /// Of these, the pixels that are at most two pixels from a line that tiles share.
    std::int64_t seam_pixels = 0;
    double seam_squares = 0;
    std::string missing = {};  ///< why the tile could not be made, in one line; empty if it is made
};

/// A tile that could not be made.
struct MissingTile {
    TileName tile;
    std::string reason;  ///< one line
};

/// A whole set.
struct TileSetIndex {
    TileSetPlan plan;
    double threshold = 0;              ///< that the tiles were made with
    std::vector<TileRecord> tiles;     ///< those made, as comes_before() has them; all have plan_key(plan)
    std::vector<MissingTile> missing;  ///< in the same order; no tile is in both, and none in neither
};

/// The order of tiles in an index: levels, then rows, then columns.
bool comes_before(const TileName& a, const TileName& b);

/// Figures of a level of a set.
struct TileTotals {
    std::int64_t tiles = 0, vertices = 0, own_vertices = 0, faces = 0, pixels = 0;
    std::uint64_t bytes = 0;  ///< of all files of the tiles
    double map_rms = 0, gouraud_rms = 0;
    std::int64_t seam_pixels = 0;
    double seam_rms = 0;
};
/// Returns those of the index's tiles of a level.
TileTotals level_totals(const TileSetIndex& index, int level);

/// Returns the record of a tile, or null if it is missing. Takes O(log tiles) time.
const TileRecord* find_tile(const TileSetIndex& index, const TileName& tile);

}  // namespace imgmesh
