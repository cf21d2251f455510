#include "libcore/tiles/tile_grid.h"

#include <algorithm>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr int kMostPixels = 1 << 30;

int parts(int pixels, std::int64_t span) {
    return static_cast<int>(std::max<std::int64_t>(1, (pixels - 1 + span - 1) / span));
}

}  // namespace

TileGrid::TileGrid(int width, int height, int step)
    : width_(width), height_(height), step_(step), levels_(1) {
    if (width < 1 || height < 1 || width > kMostPixels || height > kMostPixels)
        throw Error(ErrorKind::kBadArgument,
                    cat("the picture is ", width, "x", height, ", expected sides of 1 to ", kMostPixels));
    if (step < kLeastTile || step > kMostTile)
        throw Error(ErrorKind::kBadArgument,
                    cat("tiles is ", step, ", expected ", kLeastTile, " to ", kMostTile));
    while (columns(levels_ - 1) > 1 || rows(levels_ - 1) > 1) ++levels_;
}

int TileGrid::columns(int level) const {
    return parts(width_, span(level));
}
int TileGrid::rows(int level) const {
    return parts(height_, span(level));
}
std::int64_t TileGrid::count(int level) const {
    return std::int64_t{columns(level)} * rows(level);
}
std::int64_t TileGrid::count() const {
    std::int64_t all = 0;
    for (int level = 0; level < levels_; ++level) all += count(level);
    return all;
}

bool TileGrid::contains(const TileName& tile) const {
    return tile.level >= 0 && tile.level < levels_ && tile.column >= 0 && tile.column < columns(tile.level) &&
           tile.row >= 0 && tile.row < rows(tile.level);
}

PixelRect TileGrid::rect(const TileName& tile) const {
    const std::int64_t s = span(tile.level);
    const auto end = [&](std::int64_t part, int pixels) {
        return static_cast<int>(std::min<std::int64_t>((part + 1) * s + 1, pixels));
    };
    return {static_cast<int>(tile.column * s), static_cast<int>(tile.row * s), end(tile.column, width_),
            end(tile.row, height_)};
}

PixelRect TileGrid::own_rect(const TileName& tile) const {
    PixelRect own = rect(tile);
    if (tile.column + 1 < columns(tile.level)) --own.right;
    if (tile.row + 1 < rows(tile.level)) --own.bottom;
    return own;
}

std::vector<TileName> TileGrid::children(const TileName& tile) const {
    std::vector<TileName> found;
    if (tile.level == 0) return found;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x)
            if (const TileName child{tile.level - 1, 2 * tile.column + x, 2 * tile.row + y}; contains(child))
                found.push_back(child);
    return found;
}

TileName TileGrid::parent(const TileName& tile) const {
    return {tile.level + 1, tile.column / 2, tile.row / 2};
}

std::vector<TileName> TileGrid::tiles(int level) const {
    std::vector<TileName> all;
    for (int row = 0; row < rows(level); ++row)
        for (int column = 0; column < columns(level); ++column) all.push_back({level, column, row});
    return all;
}

GridSize level_size(const TileGrid& grid, const TileName& tile) {
    const PixelRect rect = grid.rect(tile);
    return {((rect.width() - 1) >> tile.level) + 1, ((rect.height() - 1) >> tile.level) + 1};
}

GridSize level_size(const TileGrid& grid, int level) {
    return {((grid.width() - 1) >> level) + 1, ((grid.height() - 1) >> level) + 1};
}

PixelRect own_level_rect(const TileGrid& grid, const TileName& tile) {
    const GridSize all = level_size(grid, tile.level);
    const int left = tile.column * grid.step(), top = tile.row * grid.step();
    const bool last_column = tile.column + 1 == grid.columns(tile.level),
               last_row = tile.row + 1 == grid.rows(tile.level);
    return {left, top, last_column ? all.width : left + grid.step(),
            last_row ? all.height : top + grid.step()};
}

}  // namespace imgmesh
