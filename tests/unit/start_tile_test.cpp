#include <doctest/doctest.h>

#include "libcore/simplify/kernel/start_tile.h"
#include "libcore/simplify/quadrics/quadric_sources.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// Returns the place of b's start in the cycle a; -1 if they are not rotations of each other.
int rotation(const std::vector<Id>& a, const std::vector<Id>& b) {
    for (std::size_t k = 0; k < a.size(); ++k) {
        std::vector<Id> turned = a;
        std::rotate(turned.begin(), turned.begin() + static_cast<std::ptrdiff_t>(k), turned.end());
        if (turned == b) return static_cast<int>(k);
    }
    return -1;
}

bool close(float a, float b) {
    return std::abs(a - b) <= 1e-3f + 2e-4f * std::abs(b);
}

// The tiles together must be the dense mesh that ring_mesh() and initial_quadrics() make as a whole.
void check_tiles(const GridMesh& grid) {
    const SimplifyParams params = plain_params();
    const FeaturePatch gradients = smoothed_patch(grid, params.smoothing, whole_rect(grid));
    const RingMesh rings = ring_mesh(grid);
    const auto quadrics = initial_quadrics<Quadric<3>>(grid, rings, gradients, params);
    std::vector<int> seen(rings.size(), 0);
    const StartTiles tiles(grid);
    TileMesh<Quadric<3>> tile;  // used again: nothing of one tile may stay in the next
    for (int t = 0; t < tiles.count(); ++t) {
        fill_tile(grid, params, tiles.rect(t), tile);
        const QuadricMesh<Quadric<3>>& mesh = tile.mesh;
        std::int64_t boundary = 0;
        for (Id v = 0; v < tile.own; ++v) {
            const Id number = mesh.pixel[v];
            const Ring &ring = mesh.rings[v], &expected = rings[number];
            ++seen[number];
            CHECK(tiles.of(number) == t);
            CHECK(ring.x == expected.x);
            CHECK(ring.y == expected.y);
            CHECK(ring.fixed == expected.fixed);
            std::vector<Id> around, wanted(expected.neighbor, expected.neighbor + expected.valence);
            bool leaves = false;
            for (int k = 0; k < ring.valence; ++k) {
                const Id n = ring.neighbor[k];
                around.push_back(mesh.pixel[n]);
                leaves |= n >= tile.own;
                CHECK(mesh.rings[n].x == rings[mesh.pixel[n]].x);
                CHECK(mesh.rings[n].y == rings[mesh.pixel[n]].y);
            }
            CHECK(rotation(around, wanted) >= 0);
            if (ring.border()) CHECK(around == wanted);
            CHECK((ring.locked != 0) == (leaves || (ring.border() && !grid.mask.empty())));
            boundary += ring.border() && !grid.mask.empty();
            const Quadric<3>&q = mesh.quadrics[v], &wanted_q = quadrics[number];
            for (const Vec2f& p : {Vec2f(ring.x, ring.y), Vec2f(ring.x + 1, ring.y - 2)}) {
                CHECK(close(q.at(p.x(), p.y()), wanted_q.at(p.x(), p.y())));
                for (int c = 0; c < 3; ++c)
                    CHECK(close(q.feature(c, p.x(), p.y()), wanted_q.feature(c, p.x(), p.y())));
            }
        }
        CHECK(tile.live == static_cast<std::int64_t>(tile.own));
        CHECK(tile.boundary == boundary);
        for (std::size_t v = tile.own; v < mesh.rings.size(); ++v) {
            CHECK(!mesh.rings[v].live());
            const float* color = grid.feature.pixel(mesh.pixel[v]);
            for (int c = 0; c < 3; ++c)
                CHECK(mesh.quadrics[v].feature(c, mesh.rings[v].x, mesh.rings[v].y) == color[c]);
        }
    }
    for (std::size_t v = 0; v < rings.size(); ++v) CHECK(seen[v] == (rings[v].live() ? 1 : 0));
    if (!grid.mask.empty()) CHECK(masked_face_count(grid) == face_count(rings));
}

}  // namespace

TEST_CASE("start tiles: together they are the dense mesh") {
    for (const auto& [width, height] : {std::pair(150, 131), {64, 64}, {65, 129}, {1, 70}, {70, 1}, {3, 3}}) {
        INFO(width << " x " << height);
        check_tiles(grid_mesh(sample_feature(Kind::kNoise, width, height)));
    }
}

TEST_CASE("start tiles: together they are the dense mesh of a masked image") {
    for (const auto& [name, mask] : sample_masks(150)) {
        INFO(name);
        check_tiles(grid_mesh(sample_feature(Kind::kNoise, mask.width, mask.height), mask));
    }
}

// A strip at the left of two tiles: the right one has no pixel inside.
TEST_CASE("start tiles: one outside the mask is empty, whatever it held before") {
    constexpr int kWidth = 2 * kStartTile, kHeight = kStartTile;
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, kWidth, kHeight),
                                    mask_where(kWidth, kHeight, [](int x, int) { return x < 10; }));
    const StartTiles tiles(grid);
    TileMesh<Quadric<3>> tile;
    fill_tile(grid, SimplifyParams{}, tiles.rect(0), tile);
    CHECK(tile.own == 10 * kHeight);
    fill_tile(grid, SimplifyParams{}, tiles.rect(1), tile);
    CHECK(tile.own == 0);
    CHECK(tile.live == 0);
    CHECK(tile.boundary == 0);
    CHECK(tile.mesh.rings.empty());
    CHECK(tile.mesh.quadrics.empty());
    CHECK(tile.mesh.pixel.empty());
}
