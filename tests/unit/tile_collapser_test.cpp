#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <random>

#include "libcore/simplify/kernel/edge_collapser.h"
#include "libcore/simplify/kernel/start_tile.h"
#include "libcore/simplify/kernel/tile_collapser.h"
#include "tests/support/grid_faces.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

using Mesh = QuadricMesh<Quadric<3>>;

constexpr int kWidth = 40, kHeight = 30;
const SimplifyHooks kNoHooks;

Mesh dense(Kind kind) {
    const GridMesh grid = grid_mesh(sample_feature(kind, kWidth, kHeight));
    Mesh mesh;
    mesh.rings = ring_mesh(grid);
    mesh.quadrics =
        initial_quadrics<Quadric<3>>(grid, mesh.rings, FeaturePatch{grid.feature}, plain_params());
    return mesh;
}

// Of a tile that is the mesh.
struct WholeTile {
    std::vector<TileRing> rings;
    std::vector<TileVertex> vertices;

    explicit WholeTile(const RingMesh& mesh) {
        for (const Ring& from : mesh) {
            TileRing& ring = rings.emplace_back();
            std::fill_n(ring.neighbor, TileRing::kRoom, kNoTileId);
            std::copy_n(from.neighbor, from.valence, ring.neighbor);
            vertices.push_back({from.x, from.y, from.valence, from.fixed, false});
        }
    }
};

CollapseStats collapse(Mesh& mesh, const std::vector<Id>& list, float threshold,
                       const CollapseStats& may_go = kAllMayGo) {
    const SimplifyParams params = plain_params();
    const SimplifyRules rules{params, kNoHooks, 3, {}};
    const auto number = [&](Id v) {
        const auto at = std::lower_bound(list.begin(), list.end(), v);
        return at != list.end() && *at == v ? static_cast<TileId>(at - list.begin()) : kNoTileId;
    };
    TileCollapser<Quadric<3>> collapser(rules);
    collapser.load(mesh, list, number);
    const CollapseStats stats = collapser.run(threshold, may_go);
    collapser.store(mesh, list);
    return stats;
}

std::vector<Id> vertices_where(const Mesh& mesh, float end_x) {
    std::vector<Id> list;
    for (Id v = 0; v < mesh.rings.size(); ++v)
        if (mesh.rings[v].x < end_x) list.push_back(v);
    return list;
}

bool same_ring(const Ring& a, const Ring& b) {
    return a.valence == b.valence && std::equal(a.neighbor, a.neighbor + a.valence, b.neighbor);
}

}  // namespace

TEST_CASE("numbers of 16 bits: each operation against a loop") {
    std::mt19937 random(7);
    for (int round = 0; round < 200; ++round) {
        std::uint16_t values[16];
        for (std::uint16_t& value : values)
            value = static_cast<std::uint16_t>(random() % 0x8000 >> round % 12);
        CHECK(least16(values) == *std::min_element(values, values + 16));
        const std::uint16_t wanted = values[random() % 16];
        for (unsigned k = 0; k < 16; ++k)
            CHECK((match16(values, wanted) >> k & 1) == static_cast<unsigned>(values[k] == wanted));
        CHECK(match16(values, 0xffff) == 0);
        const std::uint16_t other = values[random() % 16];
        CHECK(match16(values, wanted, other) == (match16(values, wanted) | match16(values, other)));
        const int at = static_cast<int>(random() % 16);
        std::uint16_t expected[16], result[16];
        std::copy_n(values, 16, expected);
        std::copy_n(values, 16, result);
        std::copy(values + at + 1, values + 16, expected + at);
        remove16(result, at);
        CHECK(std::equal(expected, expected + 16, result));
        std::fill(expected + at, expected + 16, wanted);
        fill16_from(result, at, wanted);
        CHECK(std::equal(expected, expected + 16, result));
    }
}

TEST_CASE("short costs: in order, and never above the cost") {
    float before = 0;
    for (float cost = 1e-30f; cost < 1e30f; cost *= 1.01f) {
        CHECK(short_cost(before) <= short_cost(cost));
        CHECK(least_cost(short_cost(cost)) <= cost);
        CHECK(least_cost(short_cost(cost)) > cost * (1 - 1.0f / 128));
        before = cost;
    }
    CHECK(short_cost(kNever) == kShortNever);
    CHECK(least_cost(kShortNever) == kNever);
}

TEST_CASE("merge_colors: as merged(), to the bit") {
    std::mt19937 random(5);
    const Mesh mesh = dense(Kind::kNoise);
    for (int round = 0; round < 500; ++round) {
        const auto any = [&] { return mesh.quadrics[random() % mesh.quadrics.size()]; };
        const Quadric<3> i = merged(any(), any()), j = any(), expected = merged(i, j);
        Quadric<3> sum;
        merge_colors(i, j, sum);
        CHECK(std::memcmp(&sum, &expected, sizeof sum) == 0);
    }
}

// Random merges until none is possible; before each, all edges of the mesh.
TEST_CASE("tile: an edge merges as in the mesh of rings") {
    std::mt19937 random(3);
    RingMesh rings = ring_mesh(grid_mesh(sample_feature(Kind::kNoise, 11, 9)));
    for (;;) {
        const WholeTile tile(rings);
        std::vector<std::pair<Id, Id>> legal;
        for (Id i = 0; i < rings.size(); ++i)
            for (int k = 0; k < rings[i].valence; ++k) {
                const Id j = rings[i].neighbor[k];
                MergedRing expected;
                MergedTileRing merged;
                const bool may = merge_rings(rings, i, j, expected);
                INFO("edge " << i << " " << j);
                CHECK(merge_rings(tile.rings, tile.vertices, static_cast<TileId>(i), static_cast<TileId>(j),
                                  merged) == may);
                if (!may) continue;
                legal.emplace_back(i, j);
                CHECK(merged.faces_removed == expected.faces_removed);
                REQUIRE(merged.valence == expected.valence);
                std::vector<Id> a(expected.neighbor.begin(), expected.neighbor.begin() + expected.valence),
                    b(merged.neighbor, merged.neighbor + merged.valence);
                const bool border = rings[i].border() || rings[j].border();
                if (!border) std::rotate(b.begin(), std::find(b.begin(), b.end(), a.front()), b.end());
                CHECK(a == b);
                for (int n = merged.valence; n < TileRing::kRoom; ++n) CHECK(merged.neighbor[n] == kNoTileId);
            }
        if (legal.empty()) break;
        const auto [i, j] = legal[random() % legal.size()];
        MergedRing merged;
        REQUIRE(merge_rings(rings, i, j, merged));
        apply_merge(rings, i, j, merged);
    }
}

// What is left are edges that cost more, or that the triangles around them forbade when they were tried. As
// those have changed, a second run may find a few.
TEST_CASE("tile: no edge below the threshold is left that may collapse") {
    for (const Kind kind : kAllKinds)
        for (const float threshold : {1e-3f, 10.0f, 1e3f, 1e6f}) {
            INFO(name_of(kind) << " below " << threshold);
            Mesh mesh = dense(kind);
            const CollapseStats stats = collapse(mesh, vertices_where(mesh, 1e9f), threshold);
            CHECK(live_list(mesh.rings).size() + static_cast<std::size_t>(stats.vertices) ==
                  kWidth * kHeight);
            CHECK(face_count(mesh.rings) + stats.faces == 2 * (kWidth - 1) * (kHeight - 1));
            CHECK(short_cost(stats.postponed) >= short_cost(threshold));
            for (Id i = 0; i < mesh.rings.size(); ++i)
                for (int k = 0; k < mesh.rings[i].valence; ++k)
                    CHECK(mesh.rings[mesh.rings[i].neighbor[k]].find(i) >= 0);
            // Between its squares nearly everything is forbidden at first.
            if (kind == Kind::kCheckerboard) continue;
            const CollapseStats again = collapse(mesh, vertices_where(mesh, 1e9f), threshold);
            CHECK(again.vertices <= 20 + (kWidth * kHeight - stats.vertices) / 20);
        }
}

// The edges are the same, and so is nearly all of their order; ties and forbidden shapes are not.
TEST_CASE("tile: about as many vertices go as from a queue") {
    for (const float threshold : {1e4f, 1e5f}) {
        INFO("below " << threshold);
        Mesh mesh = dense(Kind::kNoise), queued = mesh;
        const CollapseStats stats = collapse(mesh, vertices_where(mesh, 1e9f), threshold);
        const SimplifyParams params = plain_params();
        const SimplifyRules rules{params, kNoHooks, 3, {}};
        const CollapseStats expected =
            EdgeCollapser<Quadric<3>>(queued, rules)
                .run(
                    queued.rings.size(), [](std::size_t v) { return static_cast<Id>(v); }, threshold,
                    kAllMayGo);
        CHECK(std::abs(stats.vertices - expected.vertices) <= expected.vertices / 50);
        CHECK(expected.vertices > 100);
    }
}

TEST_CASE("tile: it stops where as many vertices are removed as may go") {
    Mesh mesh = dense(Kind::kNoise);
    CHECK(collapse(mesh, vertices_where(mesh, 1e9f), 1e6f, {.vertices = 17, .faces = 1000}).vertices == 17);
    CHECK(live_list(mesh.rings).size() == kWidth * kHeight - 17);
}

// The left half of a mesh: what lies beside it, and the vertices at the seam, stay where they are.
TEST_CASE("tile: vertices with a neighbour elsewhere stay") {
    const Mesh before = dense(Kind::kNoise);
    Mesh mesh = before;
    constexpr float kSeam = 19;  // x of the last vertices of the tile
    const CollapseStats stats = collapse(mesh, vertices_where(mesh, kSeam + 1), 1e6f);
    CHECK(stats.vertices > 400);
    CHECK(face_count(mesh.rings) + stats.faces == face_count(before.rings));
    for (Id v = 0; v < mesh.rings.size(); ++v) {
        const Ring &ring = mesh.rings[v], &old = before.rings[v];
        if (old.x < kSeam) continue;
        CHECK(ring.x == old.x);
        CHECK(ring.y == old.y);
        CHECK(mesh.quadrics[v].error == before.quadrics[v].error);
        if (old.x > kSeam) CHECK(same_ring(ring, old));
        for (int k = 0; k < ring.valence; ++k) CHECK(mesh.rings[ring.neighbor[k]].find(v) >= 0);
    }
}

// Tiles with and without a side of the image, and smaller than a vector.
TEST_CASE("tile: loaded from the grid it is what the tile's mesh makes it") {
    for (const Kind kind : {Kind::kNoise, Kind::kGradient}) {
        const GridMesh grid = grid_mesh(sample_feature(kind, 150, 133));
        const SimplifyParams params = plain_params();
        const SimplifyRules rules{params, kNoHooks, 3, {}};
        const StartTiles tiles(grid);
        TileCollapser<Quadric<3>> direct(rules), expected(rules);
        for (int t = 0; t < tiles.count(); ++t) {
            INFO(name_of(kind) << ", tile " << t);
            direct.load_grid(grid, tiles.rect(t), smoothed_patch(grid, params.smoothing, tiles.rect(t)));
            TileMesh<Quadric<3>> tile;
            fill_tile(grid, params, tiles.rect(t), tile);
            std::vector<Id> all(tile.own);
            std::iota(all.begin(), all.end(), Id{0});
            expected.load(tile.mesh, all,
                          [&](Id v) { return v < tile.own ? static_cast<TileId>(v) : kNoTileId; });
            REQUIRE(direct.vertices().size() == tile.own);
            int different = 0;
            for (std::size_t v = 0; v < tile.own; ++v) {
                const TileVertex &a = direct.vertices()[v], &b = expected.vertices()[v];
                const TileRing &ring = direct.rings()[v], &wanted = expected.rings()[v];
                different += a.x != b.x || a.y != b.y || a.valence != b.valence || a.fixed != b.fixed ||
                             a.locked != b.locked;
                different += !std::equal(ring.neighbor, ring.neighbor + TileRing::kRoom, wanted.neighbor);
                different += !std::equal(ring.cost, ring.cost + TileRing::kRoom, wanted.cost);
                different += direct.quadrics()[v].error != expected.quadrics()[v].error;
            }
            CHECK(different == 0);
        }
    }
}
