// Coarser tiles: whole, without folds, and alike on the sides that they share. And the threshold of a set.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "libcore/mesh/tile_sides.h"
#include "libcore/simplify/simplify.h"
#include "libcore/tiles/density.h"
#include "libcore/tiles/join_tiles.h"
#include "libcore/tiles/tile_errors.h"
#include "libcore/tiles/tile_joiner.h"
#include "libcore/tiles/tile_mask.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/sample_tile_set.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

std::vector<ChildTile> children_of(const TileGrid& grid, const TileName& tile) {
    const PixelRect parent = grid.rect(tile);
    std::vector<ChildTile> children;
    for (const TileName& child : grid.children(tile)) {
        const PixelRect rect = grid.rect(child);
        children.push_back({sample_mesh(grid, child), rect.left - parent.left, rect.top - parent.top,
                            rect.width(), rect.height()});
    }
    return children;
}

double area_of(const BaseMesh& mesh) {
    double area = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const double own = signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]);
        CHECK(own > 0);
        area += own / 2;
    }
    return area;
}

// The colours of the vertices of a column of a mesh, by their y.
std::map<float, std::vector<float>> column_of(const BaseMesh& mesh, float x) {
    std::map<float, std::vector<float>> found;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        if (mesh.position[v].x() == x)
            found[mesh.position[v].y()] = {mesh.feature_of(v), mesh.feature_of(v) + mesh.channels};
    return found;
}

}  // namespace

TEST_CASE("joined tiles have the vertices of a shared side once") {
    const TileGrid grid(65, 65, 32);
    const std::vector<ChildTile> parts = children_of(grid, {1, 0, 0});
    REQUIRE(parts.size() == 4);
    TileJoiner joiner;
    for (const ChildTile& part : parts)
        joiner.add(part.mesh, Vec2f(static_cast<float>(part.left), static_cast<float>(part.top)),
                   Vec2f(32, 32));
    const BaseMesh whole = joiner.take();
    // 4 x 5^2 vertices, less the 8 that two tiles have and three times the one that four have.
    CHECK(whole.vertex_count() == 81);
    CHECK(area_of(whole) == 64.0 * 64);
}

TEST_CASE("coarser tiles cover their rectangle and agree on the side that they share") {
    const TileGrid grid(257, 129, 64);
    const auto coarse = [&](const TileName& tile) {
        const PixelRect rect = grid.rect(tile);
        return coarser_tile(children_of(grid, tile), tile.level, rect.width(), rect.height(), {});
    };
    const BaseMesh left = coarse({1, 0, 0}), right = coarse({1, 1, 0});
    for (const BaseMesh* mesh : {&left, &right}) {
        CHECK(area_of(*mesh) == 128.0 * 128);
        CHECK(mesh->vertex_count() <= 17 * 17 / 4);
    }
    const auto a = column_of(left, 128), b = column_of(right, 0);
    CHECK(a.size() == 17 / 2 + 1);
    CHECK((a == b));
}

TEST_CASE("a coarser tile is made of the children that are there") {
    const TileGrid grid(129, 129, 64);
    std::vector<ChildTile> children = children_of(grid, {1, 0, 0});
    children.erase(children.begin() + 1);
    CHECK(area_of(coarser_tile(children, 1, 129, 129, {})) == 3 * 64.0 * 64);
}

TEST_CASE("the threshold of a set leaves the wanted number of vertices in its samples") {
    const TileGrid grid(97, 97, 96);
    const FeatureImage feature = sample_feature(Kind::kNoise, 97, 97);
    const DensitySample sample = sample_density(feature, {}, 0, {}, 4);
    CHECK(sample.pixels == 96.0 * 96);
    CHECK(sample.border == 4 * 96);
    CHECK(std::ranges::is_sorted(sample.counted, std::greater()));
    CHECK(std::ranges::is_sorted(sample.decided, std::greater()));
    double before = 0;
    for (const double vertices : {800.0, 400.0, 100.0}) {
        const double threshold = threshold_for(sample, grid, vertices);
        CHECK(threshold > before);
        before = threshold;
    }
}

TEST_CASE("a sample counts what a collapse to each of the thresholds leaves") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 129, 129);
    const DensitySample sample = sample_density(feature, {}, 0, {}, 4);
    const GridMesh grid = grid_mesh(feature);
    SimplifyRun run(grid, {});
    int compared = 0;
    for (std::size_t i = 0; i < sample.counted.size(); ++i) {
        const double counted = sample.counted[i] + 0.5 * sample.on_sides[i];
        if (counted > 2000 || counted < 400) continue;
        ++compared;
        const SimplifyResult reached = run.to({.vertices = 4, .max_increment = sample_thresholds()[i]});
        CHECK(std::abs(static_cast<double>(reached.mesh.vertex_count()) / counted - 1) < 0.03);
    }
    CHECK(compared > 5);
}

TEST_CASE("windows have the density of the whole where they count") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 257, 257);
    const DensitySample whole = sample_density(feature, {}, 0, {}, 4);
    DensitySample windows;
    for (int y = 0; y <= 192; y += 64)
        for (int x = 0; x <= 192; x += 64) {
            FeatureImage part{65, 65, feature.channels, {}};
            for (int row = y; row < y + 65; ++row)
                part.data.insert(part.data.end(), feature.pixel(x, row),
                                 feature.pixel(x, row) + 65 * feature.channels);
            windows.add(sample_density(std::move(part), {}, 8, {}, 4));
        }
    CHECK(windows.pixels == 16 * 48 * 48);
    std::size_t compared = 0;
    for (std::size_t i = 0; i < whole.counted.size(); ++i) {
        const double expected = whole.counted[i] / whole.pixels;
        if (expected < 0.02 || expected > 0.08) continue;
        ++compared;
        CHECK(std::abs(windows.counted[i] / windows.pixels / expected - 1) < 0.02);
    }
    CHECK(compared > 2);
}

TEST_CASE("small pictures are sampled as a whole, large ones in parts all over") {
    const TileGrid small(1000, 700, 512), large(20000, 20000, 1024);
    CHECK(sampled_parts(small, 0, 1).size() == 2);
    CHECK(sampled_parts(small, 1, 1).front().pixels.bottom == 700);
    std::int64_t pixels = 0;
    for (int row = 0; row < large.rows(0); ++row)
        for (const auto& [part, margin] : sampled_parts(large, row, 1)) {
            CHECK(margin == 16);
            CHECK((part.left >= 0 && part.top >= 0 && part.right <= 20000 && part.bottom <= 20000));
            pixels += std::int64_t{part.width() - 1} * (part.height() - 1);
        }
    CHECK(pixels > 20000LL * 20000 / 12);
    CHECK(pixels < 20000LL * 20000 / 6);
}

TEST_CASE("the errors of tiles are those of the pixels that they own") {
    const TileGrid grid(65, 33, 32);
    FeatureImage feature{33, 33, 3, std::vector<float>(33 * 33 * 3, 0.0f)};
    Level level;
    level.mesh.position = {Vec2f(0, 0), Vec2f(32, 0), Vec2f(0, 32)};
    level.mesh.feature.assign(9, 2.0f);
    level.mesh.faces = {Face{0, 2, 1}};
    level.map = PixelMap(33, 33, std::vector<PixelCoord>(33 * 33, PixelCoord{0, 0, 0}));
    const TileErrors errors =
        tile_errors(level, feature, tile_mask({}, grid, {0, 0, 0}).own, {.right = true});
    CHECK(errors.pixels == 32 * 33);
    CHECK(errors.squares == 32 * 33 * 12.0);
    CHECK(errors.seam_pixels == 2 * 33);
}
