// Masks that cross tiles: every pixel inside belongs to one tile that has a face for it.
#include "libcore/tiles/tile_mask.h"

#include <doctest/doctest.h>

#include <random>

using namespace imgmesh;

namespace {

Mask part_of(const Mask& mask, const PixelRect& rect) {
    Mask part{rect.width(), rect.height(), {}};
    for (int y = rect.top; y < rect.bottom; ++y)
        for (int x = rect.left; x < rect.right; ++x) part.values.push_back(mask.at(x, y));
    return part;
}

// How many tiles have each pixel as their own; checks that each of these is meshed.
Grid<int> owners(const Mask& mask, const TileGrid& grid) {
    Grid<int> count(mask);
    for (const TileName& tile : grid.tiles(0)) {
        const PixelRect rect = grid.rect(tile);
        const TileMask own = tile_mask(part_of(mask, reach_of(grid, tile)), grid, tile);
        for (int y = rect.top; y < rect.bottom; ++y)
            for (int x = rect.left; x < rect.right; ++x) {
                const int i = x - rect.left, j = y - rect.top;
                const bool meshed = own.mask.empty() || own.mask.at(i, j);
                CHECK((!meshed || mask.at(x, y)));
                if (!own.own.at(i, j)) continue;
                CHECK(meshed);
                ++count.at(x, y);
            }
    }
    return count;
}

void check_owners(const Mask& mask, const TileGrid& grid) {
    const Grid<int> count = owners(mask, grid);
    for (std::size_t i = 0; i < count.size(); ++i) CHECK(count[i] == (mask.contains(i) ? 1 : 0));
}

}  // namespace

TEST_CASE("tile_mask: each pixel inside is some tile's own, once") {
    const TileGrid grid(53, 37, 16);
    std::mt19937 random(7);
    for (const unsigned share : {1u, 8u, 16u, 24u, 31u}) {
        Mask mask(GridSize{53, 37}, 0);
        for (std::uint8_t& pixel : mask.values) pixel = random() % 32 < share;
        check_owners(mask, grid);
    }
    // A line along a shared side has faces in no tile's cells.
    Mask lines(GridSize{53, 37}, 0);
    for (int y = 0; y < 37; ++y) lines.Grid::at(16, y) = 1;
    lines.Grid::at(32, 32) = 1;
    check_owners(lines, grid);
}

TEST_CASE("tile_mask: all pixels of a picture without a mask") {
    const TileGrid grid(53, 37, 16);
    const TileMask own = tile_mask({}, grid, {0, 1, 1});
    CHECK(own.mask.empty());
    CHECK(own.own.count() == 16 * 16);
    CHECK(!(own.cut.left || own.cut.top || own.cut.right || own.cut.bottom));
    check_owners(Mask(GridSize{53, 37}, 1), grid);
}

TEST_CASE("tile_mask: both tiles of a side know whether it is cut") {
    const TileGrid grid(33, 17, 16);
    // The pixel right of the line splits the vertex on it, in the right tile alone.
    Mask mask(GridSize{33, 17}, 1);
    mask.Grid::at(17, 8) = 0;
    CHECK(tile_mask(part_of(mask, reach_of(grid, {0, 0, 0})), grid, {0, 0, 0}).cut.right);
    CHECK(tile_mask(part_of(mask, reach_of(grid, {0, 1, 0})), grid, {0, 1, 0}).cut.left);
    mask.Grid::at(17, 8) = 1;
    mask.Grid::at(18, 8) = 0;
    CHECK(!tile_mask(part_of(mask, reach_of(grid, {0, 0, 0})), grid, {0, 0, 0}).cut.right);
    CHECK(!tile_mask(part_of(mask, reach_of(grid, {0, 1, 0})), grid, {0, 1, 0}).cut.left);
}

TEST_CASE("tile_mask: a part that ends on a shared line belongs to the tile that has faces for it") {
    const TileGrid grid(33, 17, 16);
    Mask mask(GridSize{33, 17}, 0);
    for (int y = 0; y < 17; ++y)
        for (int x = 0; x <= 16; ++x) mask.Grid::at(x, y) = 1;
    const TileMask left = tile_mask(part_of(mask, reach_of(grid, {0, 0, 0})), grid, {0, 0, 0});
    CHECK(left.own.count() == 17 * 17);
    CHECK(tile_mask(part_of(mask, reach_of(grid, {0, 1, 0})), grid, {0, 1, 0}).has_none());
}
