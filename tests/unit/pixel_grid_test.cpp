#include "libcore/base/grid.h"

#include <doctest/doctest.h>

#include <numeric>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grid_neighbors.h"

using namespace imgmesh;

// Row by row from the top: the third pixel of the second row of a grid four wide is number 4 + 2.
TEST_CASE("grid: a column and a row become an index, and come back") {
    const GridSize size{4, 3};
    CHECK(size.pixel_count() == 12);
    CHECK(size.index(2, 1) == 6);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x) {
            CHECK(size.x_of(size.index(x, y)) == x);
            CHECK(size.y_of(size.index(x, y)) == y);
            CHECK(size.index(x, y) == size.row_begin(y) + static_cast<std::size_t>(x));
        }
}

TEST_CASE("grid: contains what lies on no side's far side") {
    const GridSize size{4, 3};
    int inside = 0;
    for (int y = -2; y < 6; ++y)
        for (int x = -2; x < 6; ++x) inside += size.contains(x, y);
    CHECK(inside == 12);
    CHECK((size.contains(0, 0) && size.contains(3, 2)));
    CHECK_FALSE(GridSize{}.contains(0, 0));
}

// 46341^2 is the first square above 2^31: a product of ints would overflow.
TEST_CASE("grid: the pixels of a large image are counted without overflow") {
    CHECK(GridSize{65535, 65535}.pixel_count() == 4294836225u);
    CHECK(GridSize{46341, 46341}.index(46340, 46340) == 2147488280u);
}

TEST_CASE("grid: at, rows and indices name the same values") {
    Grid<int> grid({3, 2}, 7);
    CHECK(grid.values == std::vector<int>(6, 7));
    std::iota(grid.begin(), grid.end(), 0);
    CHECK(grid.at(1, 1) == 4);
    CHECK(grid[4] == 4);
    CHECK(grid.row(1).size() == 3);
    grid.row(1)[2] = 50;
    CHECK(grid.at(2, 1) == 50);
    CHECK(grid == Grid<int>(3, 2, {0, 1, 2, 3, 4, 50}));
    CHECK_FALSE(grid == Grid<int>(2, 3, {0, 1, 2, 3, 4, 50}));
}

TEST_CASE("channel grid: samples of a pixel stand side by side") {
    ChannelGrid grid(3, 2, 2, std::vector<float>(12));
    std::iota(grid.data.begin(), grid.data.end(), 0.0f);
    CHECK(grid.sample_count() == 12);
    CHECK(grid.row_size() == 6);
    CHECK(grid.pixel(1, 1)[1] == 9);
    CHECK(grid.pixel(std::size_t{4}) == grid.pixel(1, 1));
    CHECK(grid.row(1).data() == grid.pixel(0, 1));
}

// Two pixels a side have a pair in each row and each column; a column of three has two pairs, all downwards.
TEST_CASE("grid: pixels that share a side") {
    const auto pairs = [](const GridSize& size) {
        std::vector<std::pair<std::size_t, std::size_t>> all;
        for_neighbor_pixels(size, [&](std::size_t i, std::size_t j) { all.emplace_back(i, j); });
        return all;
    };
    using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
    CHECK(pairs({2, 2}) == Pairs{{0, 1}, {0, 2}, {1, 3}, {2, 3}});
    CHECK(pairs({1, 3}) == Pairs{{0, 1}, {1, 2}});
    CHECK(pairs({1, 1}).empty());
}

TEST_CASE("disjoint sets are known by their least member") {
    DisjointSets sets(6);
    CHECK(sets.count() == 6);
    sets.join(5, 3);
    sets.join(4, 5);
    sets.join(3, 4);
    CHECK(sets.find(4) == 3);
    CHECK(sets.find(5) == 3);
    CHECK(sets.find(2) == 2);
    sets.join(0, 4);
    CHECK(sets.find(5) == 0);
    CHECK(sets.count() == 3);
}
