#include <doctest/doctest.h>

#include "libcore/mesh/base_mesh.h"
#include "tests/support/grid_faces.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

FeatureImage one_channel(int width, int height, std::vector<float> data) {
    return {width, height, 1, std::move(data)};
}

// A grid of one channel with the diagonals given by the bits of `pattern`.
GridMesh patterned_grid(int width, int height, std::uint32_t pattern) {
    GridMesh grid;
    grid.feature = one_channel(width, height, std::vector<float>(static_cast<std::size_t>(width * height)));
    grid.diagonal = Grid<std::uint8_t>({width - 1, height - 1});
    for (std::size_t k = 0; k < grid.diagonal.size(); ++k) grid.diagonal[k] = pattern >> k & 1;
    return grid;
}

void check_rings(const GridMesh& grid) {
    const std::vector<Face> faces = grid_faces(grid);
    const RingMesh rings = ring_mesh(grid);
    const auto w = static_cast<Id>(grid.feature.width), h = static_cast<Id>(grid.feature.height);
    REQUIRE(rings.size() == w * h);
    for (Id v = 0; v < rings.size(); ++v) {
        INFO("vertex " << v);
        bool border = false;
        const std::vector<Id> expected = ring_of(faces, v, border);
        CHECK(rings[v].border() == border);
        CHECK(neighbors_of(rings[v]) == expected);
        CHECK(rings[v].x == grid.origin_x + static_cast<float>(v % w));
        CHECK(rings[v].y == grid.origin_y + static_cast<float>(v / w));
        CHECK(bool(rings[v].fixed & kFixedX) == (v % w == 0 || v % w == w - 1));
        CHECK(bool(rings[v].fixed & kFixedY) == (v / w == 0 || v / w == h - 1));
        // Consecutive neighbours turn counter-clockwise on screen.
        for (int k = 0; k + (border ? 1 : 0) < rings[v].valence; ++k) {
            const Ring &a = rings[rings[v].neighbor[k]],
                       &b = rings[rings[v].neighbor[(k + 1) % rings[v].valence]];
            CHECK(signed_area2({rings[v].x, rings[v].y}, {a.x, a.y}, {b.x, b.y}) == 1);
        }
    }
    const std::vector<Id> live = live_list(rings);
    CHECK(in_standard_order(ring_faces(rings, live)) == in_standard_order(faces));
    CHECK(live.size() == rings.size());
}

}  // namespace

TEST_CASE("grid mesh: the diagonal joins the two pixels that differ less") {
    // Top left and bottom right are alike.
    CHECK(grid_mesh(one_channel(2, 2, {1, 5, 9, 1.5f})).falling_diagonal(0, 0));
    // Top right and bottom left are.
    CHECK_FALSE(grid_mesh(one_channel(2, 2, {1, 5, 5.5f, 9})).falling_diagonal(0, 0));
    // Ties fall: 3 - 1 == 4 - 2.
    CHECK(grid_mesh(one_channel(2, 2, {1, 2, 4, 3})).falling_diagonal(0, 0));
}

TEST_CASE("grid mesh: distances count all channels, cell by cell") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 7, 5));
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 6; ++x) {
            const auto color = [&](int px, int py) { return Vec3f(grid.feature.pixel(px, py)); };
            const float falling = (color(x, y) - color(x + 1, y + 1)).norm(),
                        rising = (color(x + 1, y) - color(x, y + 1)).norm();
            CHECK(grid.falling_diagonal(x, y) == (falling <= rising));
        }
}

TEST_CASE("grid mesh: a side of one pixel becomes a strip one pixel wide") {
    const GridMesh column = grid_mesh(one_channel(1, 3, {1, 2, 3}));
    CHECK(column.feature.width == 2);
    CHECK(column.feature.height == 3);
    CHECK(column.feature.data == std::vector<float>{1, 1, 2, 2, 3, 3});
    CHECK(column.origin_x == -0.5f);
    CHECK(column.origin_y == 0);
    const GridMesh row = grid_mesh(one_channel(3, 1, {1, 2, 3}));
    CHECK(row.feature.data == std::vector<float>{1, 2, 3, 1, 2, 3});
    CHECK(row.origin_x == 0);
    CHECK(row.origin_y == -0.5f);
    const GridMesh pixel = grid_mesh(one_channel(1, 1, {7}));
    CHECK(pixel.feature.data == std::vector<float>{7, 7, 7, 7});
    CHECK(pixel.diagonal.size() == 1);
    for (const GridMesh* grid : {&column, &row, &pixel}) check_rings(*grid);
}

TEST_CASE("smoothed: the filter is [1 2 1] / 4 both ways, with borders repeated") {
    const FeatureImage inside = smoothed(one_channel(3, 3, {0, 0, 0, 0, 16, 0, 0, 0, 0}), 1);
    CHECK(inside.data == std::vector<float>{1, 2, 1, 2, 4, 2, 1, 2, 1});
    const FeatureImage corner = smoothed(one_channel(3, 2, {16, 0, 0, 0, 0, 0}), 1);
    CHECK(corner.data == std::vector<float>{9, 3, 0, 3, 1, 0});
}

TEST_CASE("smoothed: channels stay apart, passes repeat, a constant stays") {
    const FeatureImage noise = sample_feature(Kind::kNoise, 6, 4);
    CHECK(smoothed(noise, 0).data == noise.data);
    CHECK(smoothed(noise, 3).data == smoothed(smoothed(smoothed(noise, 1), 1), 1).data);
    FeatureImage first = one_channel(6, 4, {});
    for (std::size_t i = 0; i < noise.pixel_count(); ++i) first.data.push_back(noise.pixel(i)[0]);
    const FeatureImage all = smoothed(noise, 2), alone = smoothed(first, 2);
    for (std::size_t i = 0; i < noise.pixel_count(); ++i) CHECK(all.pixel(i)[0] == alone.pixel(i)[0]);
    const FeatureImage flat = sample_feature(Kind::kConstant, 5, 5);
    CHECK(smoothed(flat, 4).data == flat.data);
}

TEST_CASE("ring mesh: every diagonal pattern of a 3 x 3 grid") {
    for (std::uint32_t pattern = 0; pattern < 16; ++pattern) {
        INFO("pattern " << pattern);
        check_rings(patterned_grid(3, 3, pattern));
    }
}

TEST_CASE("ring mesh: small and narrow grids") {
    for (const auto& [w, h] : {std::pair{2, 2}, {2, 3}, {3, 2}, {2, 6}, {6, 2}, {5, 4}, {7, 5}})
        for (const std::uint32_t pattern : {0u, ~0u, 0x2C9A65B3u}) {
            INFO(w << " x " << h << ", pattern " << pattern);
            check_rings(patterned_grid(w, h, pattern));
        }
}

TEST_CASE("rings: those of vertices inside, in the numbers of any rectangle") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 12, 9));
    for (int y = 1; y < 8; ++y)
        for (int x = 1; x < 11; ++x) {
            const Ring whole = grid_ring(grid, x, y);
            const auto v = static_cast<Id>(y * 12 + x);
            const Ring same = inner_ring(grid, x, y, v, 12), other = inner_ring(grid, x, y, 1000, 100);
            CHECK(same.valence == whole.valence);
            CHECK(same.x == whole.x);
            CHECK(same.y == whole.y);
            CHECK(!same.border());
            for (int k = 0; k < whole.valence; ++k) {
                CHECK(same.neighbor[k] == whole.neighbor[k]);
                const int step = static_cast<int>(whole.neighbor[k] - v), dy = step > 1    ? 1
                                                                               : step < -1 ? -1
                                                                                           : 0;
                CHECK(static_cast<int>(other.neighbor[k]) - 1000 == step - 12 * dy + 100 * dy);
            }
        }
}
