// Tiles cover each step between pixels once, at every level.
#include "libcore/tiles/tile_grid.h"

#include <doctest/doctest.h>

#include "libcore/base/error.h"

using namespace imgmesh;

namespace {

struct Size {
    int width, height, step;
};
const Size kSizes[] = {{1, 1, 16}, {1, 40, 16}, {17, 17, 16}, {18, 16, 16}, {100, 35, 16}, {1000, 3, 64}};

}  // namespace

TEST_CASE("tiles of each level cover each step between pixels once") {
    for (const auto& [width, height, step] : kSizes) {
        const TileGrid grid(width, height, step);
        for (int level = 0; level < grid.levels(); ++level) {
            std::int64_t steps = 0, pixels = 0;
            for (const TileName& tile : grid.tiles(level)) {
                const PixelRect rect = grid.rect(tile), own = grid.own_rect(tile);
                CHECK((rect.left >= 0 && rect.right <= width && rect.top >= 0 && rect.bottom <= height));
                steps += std::int64_t{std::max(1, rect.width() - 1)} * std::max(1, rect.height() - 1);
                pixels += std::int64_t{own.width()} * own.height();
            }
            CHECK(steps == std::int64_t{std::max(1, width - 1)} * std::max(1, height - 1));
            CHECK(pixels == std::int64_t{width} * height);
        }
        CHECK(grid.count(grid.levels() - 1) == 1);
    }
}

TEST_CASE("neighbours share a line of pixels") {
    const TileGrid grid(100, 35, 16);
    CHECK(grid.columns(0) == 7);
    CHECK(grid.rows(0) == 3);
    CHECK(grid.levels() == 4);
    CHECK(grid.rect({0, 1, 0}).left == grid.rect({0, 0, 0}).right - 1);
    CHECK(grid.rect({0, 6, 2}).right == 100);
    CHECK(grid.own_rect({0, 0, 0}).right == 16);
}

TEST_CASE("the children of a tile cover it") {
    const TileGrid grid(100, 35, 16);
    for (int level = 1; level < grid.levels(); ++level)
        for (const TileName& tile : grid.tiles(level)) {
            const std::vector<TileName> children = grid.children(tile);
            CHECK(grid.rect(children.front()).left == grid.rect(tile).left);
            CHECK(grid.rect(children.back()).right == grid.rect(tile).right);
            CHECK(grid.rect(children.back()).bottom == grid.rect(tile).bottom);
            for (const TileName& child : children) CHECK((grid.parent(child) == tile));
        }
    CHECK(grid.children({0, 0, 0}).empty());
}

TEST_CASE("sizes out of range are refused") {
    CHECK_THROWS_AS(TileGrid(0, 5, 64), Error);
    CHECK_THROWS_AS(TileGrid(5, 5, 8), Error);
    CHECK_THROWS_AS(TileGrid(5, 5, 10000), Error);
}
