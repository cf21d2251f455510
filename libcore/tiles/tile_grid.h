// The tiles of a picture of any size: where they lie, and how coarser ones are made of finer ones.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// Names a tile: level 0 is the finest, columns run to the right, rows down.
struct TileName {
    int level = 0, column = 0, row = 0;

    bool operator==(const TileName&) const = default;
};

/// The steps between pixels that a side of a tile may have.
inline constexpr int kLeastTile = 16, kMostTile = 8192;

/// A pyramid of tiles over a picture. A tile of level k covers the steps between pixels from c S 2^k to
/// (c + 1) S 2^k, so it has the pixels at both ends: neighbours share a line of pixels, and no step between
/// two pixels is in two tiles. Each level has half the columns and rows of the one before, rounded up, down
/// to a single tile. Tiles at the right and at the bottom may be smaller.
class TileGrid {
  public:
    /// width, height  of the picture [pixels], 1 to 2^30
    /// step           S, the steps along a side of a tile of level 0, kLeastTile to kMostTile
    /// Throws Error(kBadArgument) for other numbers.
    TileGrid(int width, int height, int step);

    int width() const { return width_; }
    int height() const { return height_; }
    int step() const { return step_; }
    int levels() const { return levels_; }
    int columns(int level) const;
    int rows(int level) const;
    std::int64_t count(int level) const;
    /// Of all levels.
    std::int64_t count() const;
    bool contains(const TileName& tile) const;

    /// Returns the pixels of level 0 that a tile covers, those it shares with its neighbours included.
    PixelRect rect(const TileName& tile) const;
    /// Returns the pixels that belong to a tile of level 0 alone: of a shared line the tile to the right of
    /// it, or below it, has them.
    PixelRect own_rect(const TileName& tile) const;

    /// Returns the tiles of the level below that `tile` consists of: one, two or four, row by row.
    std::vector<TileName> children(const TileName& tile) const;
    TileName parent(const TileName& tile) const;
    /// Returns all tiles of a level, row by row.
    std::vector<TileName> tiles(int level) const;

  private:
    std::int64_t span(int level) const { return std::int64_t{step_} << level; }

    int width_, height_, step_, levels_;
};

/// Returns the size of the picture at 1 / 2^level of its size: of the pixels whose centres lie on it.
GridSize level_size(const TileGrid& grid, int level);
/// The same of a tile alone, with the lines that it shares.
GridSize level_size(const TileGrid& grid, const TileName& tile);
/// Returns where in level_size(grid, tile.level) the pixels are that belong to a tile alone: of a shared line
/// the tile to the right of it, or below it, has them.
PixelRect own_level_rect(const TileGrid& grid, const TileName& tile);

}  // namespace imgmesh
