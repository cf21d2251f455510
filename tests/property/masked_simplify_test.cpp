// What must hold for the mesh of any masked image: its topology, that it covers the mask, and that it stays
// close.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "libcore/base/parallel.h"
#include "libcore/mesh/raster.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/metrics/metrics.h"
#include "libcore/simplify/kernel/mask_boundary.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/mesh_cover.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

GridMesh masked_grid(const Mask& mask, Kind kind = Kind::kNoise) {
    return grid_mesh(sample_feature(kind, mask.width, mask.height), mask);
}

BaseMesh dense_mesh(const GridMesh& grid) {
    BaseMesh mesh;
    const RingMesh rings = ring_mesh(grid);
    const std::vector<Id> live = live_list(rings);
    mesh.faces = ring_faces(rings, live);
    for (const Id v : live) mesh.position.emplace_back(rings[v].x, rings[v].y);
    mesh.feature.resize(3 * live.size());
    return mesh;
}

BaseMesh coarse_mesh(const GridMesh& grid, std::int64_t vertices) {
    return simplify(grid, plain_params(), SimplifyTarget{.vertices = vertices}).mesh;
}

// Directly from the rule: two triangles for a cell of four, one for three; n pixels of a bare run make 2 (n -
// 1), and a bare pixel alone makes 2. Counted by flags of cells, not by the surroundings of a pixel.
std::int64_t expected_faces(const Mask& m, double& area) {
    std::int64_t faces = 0;
    std::vector<bool> covered(m.size());
    const auto index = [&](int x, int y) { return static_cast<std::size_t>(y * m.width + x); };
    for (int y = 0; y + 1 < m.height; ++y)
        for (int x = 0; x + 1 < m.width; ++x) {
            int inside = 0;
            for (const int k : {0, 1, 2, 3}) inside += m.at(x + k % 2, y + k / 2);
            if (inside < 3) continue;
            faces += inside - 2;
            for (const int k : {0, 1, 2, 3}) covered[index(x + k % 2, y + k / 2)] = true;
        }
    area = 0.5 * static_cast<double>(faces);
    const auto bare = [&](int x, int y) { return m.at(x, y) && !covered[index(x, y)]; };
    for (int y = 0; y < m.height; ++y)
        for (int x = 0; x < m.width; ++x) {
            if (!bare(x, y)) continue;
            const bool linked = bare(x - 1, y) || bare(x + 1, y) || bare(x, y - 1) || bare(x, y + 1);
            const int quads = linked ? bare(x + 1, y) + bare(x, y + 1) : 1;
            faces += 2 * quads;
            area += quads;
        }
    return faces;
}

// Everything that the dense mesh covers stays covered, exactly once.
void check_hull(const BaseMesh& mesh, const BaseMesh& dense, const Mask& mask) {
    const std::vector<int> before = faces_over_points(dense, mask.width, mask.height),
                           after = faces_over_points(mesh, mask.width, mask.height);
    int bare = 0, twice = 0;
    for (std::size_t i = 0; i < before.size(); ++i) {
        bare += after[i] < before[i];
        twice += after[i] > 1;
    }
    CHECK(bare == 0);
    CHECK(twice == 0);
}

void check_topology(const BaseMesh& mesh, const MeshQuality& dense) {
    const MeshQuality q = mesh_quality(mesh);
    CHECK(q.components == dense.components);
    CHECK(q.euler == dense.euler);
    CHECK(q.nonmanifold_edges + q.nonmanifold_vertices + q.flipped_faces == 0);
    CHECK(q.area >= dense.area);
}

void check_covers(const BaseMesh& mesh, const Mask& mask) {
    const PixelMap map = rasterize(mesh, sample_grid(mask.width, mask.height, 1));
    std::int64_t uncovered = 0;
    for (std::size_t i = 0; i < map.size(); ++i) uncovered += mask.contains(i) && map[i].face == kNone;
    CHECK(uncovered == 0);
}

using Places = std::vector<std::pair<float, float>>;

Places vertices_on_sides(const BaseMesh& mesh, int width, int height) {
    Places places;
    for (const Vec2f& p : mesh.position)
        if (on_side(p, width, height)) places.emplace_back(p.x(), p.y());
    std::sort(places.begin(), places.end());
    return places;
}

// Those to be kept, and those where the boundary comes to the side or leaves it.
Places side_vertices_that_stay(const BaseMesh& dense, const GridMesh& grid) {
    const int w = grid.feature.width, h = grid.feature.height;
    const auto straight_on = [](double place, double p, double q, int last) {
        return place == p && place == q && (place == 0 || place == last);
    };
    std::map<std::pair<float, float>, std::vector<Segment>> edges;
    for (const auto& [p, q] : boundary(dense)) {
        edges[{static_cast<float>(p.x()), static_cast<float>(p.y())}].emplace_back(p, q);
        edges[{static_cast<float>(q.x()), static_cast<float>(q.y())}].emplace_back(q, p);
    }
    Places places;
    for (const auto& at : vertices_on_sides(dense, w, h)) {
        const std::vector<Segment>& two = edges[at];
        const bool straight =
            two.size() == 2 && (straight_on(at.first, two[0].second.x(), two[1].second.x(), w - 1) ||
                                straight_on(at.second, two[0].second.y(), two[1].second.y(), h - 1));
        const Id pixel =
            static_cast<Id>(std::floor(at.second)) * as_id(as_index(w)) + static_cast<Id>(at.first);
        const bool whole = at.first == std::floor(at.first) && at.second == std::floor(at.second);
        if (!whole || !straight || grid.keeps(pixel)) places.push_back(at);
    }
    return places;
}

}  // namespace

// Small enough to count by hand: vertices, faces, components and Euler characteristic.
TEST_CASE("masked images: the dense mesh of small masks") {
    struct Case {
        std::vector<std::string> rows;
        std::size_t vertices, faces;
        std::int64_t components, euler;
    };
    for (const Case& c : {
             Case{{"##", "##"}, 4, 2, 1, 1}, Case{{"#.", "##"}, 3, 1, 1, 1},
             Case{{"#.", ".#"}, 8, 4, 2, 2},                                     // two squares
             Case{{"####"}, 8, 6, 1, 1},                                         // a strip
             Case{{"#", "#", ".", "#"}, 8, 4, 2, 2},                             // a strip and a square
             Case{{"#####", "#####", "##.##", "#####", "#####"}, 24, 28, 1, 0},  // a hole
             Case{{"###", "#.#", "###"}, 12, 4, 4, 4},                           // a triangle at each corner
             Case{{"##.", "###", ".##"}, 7, 6, 1, 1},                            // a band along the diagonal
             Case{{"##..", "##..", "..##", "..##"}, 8, 4, 2, 2},  // islands that touch at no vertex
             Case{{"##.##", "#####", "##.##"}, 14, 12, 2, 2},     // joined at one pixel, which is split
             Case{{"##.##", "##.##", "..#..", "##.##", "##.##"}, 20, 10, 5, 5},
             Case{{"##...", "##...", ".####", "...##"}, 11, 7, 2, 2},
             Case{{"##..##", "######", "##..##"}, 14, 12, 2, 2},    // a line between, of no pixel of its own
             Case{{"##...##", "#######", "##...##"}, 18, 14, 3, 3}  // and of one
         }) {
        INFO(c.rows[0] << " " << c.rows.size());
        const BaseMesh mesh = dense_mesh(masked_grid(mask_of(c.rows)));
        const MeshQuality q = mesh_quality(mesh);
        CHECK(mesh.vertex_count() == c.vertices);
        CHECK(mesh.faces.size() == c.faces);
        CHECK(q.components == c.components);
        CHECK(q.euler == c.euler);
        CHECK(q.nonmanifold_edges + q.nonmanifold_vertices + q.flipped_faces == 0);
    }
}

// A pixel with triangles to its left and right and none between them is two vertices.
TEST_CASE("masked images: a pinch is split") {
    const GridMesh pinched = masked_grid(mask_of({"#.#", "###", "#.#"}));
    // Left: triangles (0,0) (0,1) (1,1) and (0,1) (0,2) (1,1); right likewise: the middle is shared by both.
    REQUIRE(pinched.copies == std::vector<Id>{4});
    const RingMesh rings = ring_mesh(pinched);
    CHECK(rings[4].valence == 3);
    CHECK(rings[9].valence == 3);
    CHECK(rings[9].x == 1);
    CHECK(rings[9].y == 1);
    CHECK(mesh_quality(dense_mesh(pinched)).components == 2);
}

TEST_CASE("masked images: the dense mesh has the faces that the cells say, once each") {
    for (const auto& [name, mask] : sample_masks(40)) {
        INFO(name);
        const BaseMesh mesh = dense_mesh(masked_grid(mask));
        double area = 0;
        CHECK(static_cast<std::int64_t>(mesh.faces.size()) == expected_faces(mask, area));
        const MeshQuality q = mesh_quality(mesh);
        CHECK(q.area == area);
        CHECK(q.nonmanifold_edges + q.nonmanifold_vertices + q.flipped_faces == 0);
        check_covers(mesh, mask);
    }
}

TEST_CASE("masked images: a mask with all pixels inside is meshed as if there were none") {
    const Mask full = mask_where(30, 22, [](int, int) { return true; });
    const BaseMesh with = dense_mesh(masked_grid(full)), without = dense_mesh(masked_grid(Mask{30, 22, {}}));
    CHECK(with.position == without.position);
    CHECK(with.faces == without.faces);
}

TEST_CASE("masked images: topology is kept, every pixel stays covered, and the boundary stays close") {
    for (const auto& [name, mask] : sample_masks(40))
        for (const Kind kind : {Kind::kNoise, Kind::kConstant, Kind::kDisc}) {
            const GridMesh grid = masked_grid(mask, kind);
            const BaseMesh dense = dense_mesh(grid);
            const MeshQuality dense_quality = mesh_quality(dense);
            for (const std::int64_t vertices : {200, 0}) {
                INFO(name << ", " << name_of(kind) << ", " << vertices << " vertices");
                const BaseMesh mesh = coarse_mesh(grid, vertices);
                check_topology(mesh, dense_quality);
                check_covers(mesh, mask);
                if (vertices != 0) continue;
                check_hull(mesh, dense, mask);
                const auto from = boundary(dense), to = boundary(mesh);
                for (const auto& [a, b] : from)  // the pixels are covered: so is what lies between them
                    if (!covers(mesh, (a + b) / 2)) FAIL_CHECK("the boundary at " << a << " is cut off");
                CHECK(distance_from_to(from, to) <= kBoundaryBand + 1e-4);
                CHECK(distance_from_to(to, from) <= kBoundaryBand + 1e-4);
            }
        }
}

// Of a side that the mask cuts all pixels are to be kept; others may go where the boundary runs along the
// side.
TEST_CASE("masked images: what is decided of the image's sides is what is left there") {
    int went = 0;
    for (std::uint32_t seed = 1; seed <= 150; ++seed) {
        const Mask mask = random_mask(seed);
        const int w = mask.width, h = mask.height;
        if (w < 2 || h < 2) continue;
        for (const unsigned one_in : {1u, 4u}) {
            INFO("seed " << seed << ", one in " << one_in);
            GridMesh grid = masked_grid(mask, kAllKinds[seed % 5]);
            const BaseMesh dense = dense_mesh(grid);
            std::mt19937 random(seed);
            for (Id p = 0; p < mask.size(); ++p) {
                const Vec2f at(static_cast<float>(grid.feature.x_of(p)),
                               static_cast<float>(grid.feature.y_of(p)));
                if (on_side(at, w, h) && mask.contains(p) && random() % one_in == 0)
                    grid.side_vertices.push_back(p);
            }
            if (grid.side_vertices.empty()) continue;
            const auto stays = side_vertices_that_stay(dense, grid);
            for (const std::int64_t vertices : {200, 0}) {
                const BaseMesh mesh = coarse_mesh(grid, vertices);
                check_topology(mesh, mesh_quality(dense));
                check_covers(mesh, mask);
                CHECK((vertices_on_sides(mesh, w, h) == stays));
            }
            went += stays != vertices_on_sides(dense, w, h);
        }
    }
    CHECK(went > 50);
}

TEST_CASE("masked images: masks at random keep topology, pixels and distance") {
    for (std::uint32_t seed = 1; seed <= 150; ++seed) {
        INFO("seed " << seed);
        const Mask mask = random_mask(seed);
        const GridMesh grid = masked_grid(mask, kAllKinds[seed % 5]);
        const BaseMesh dense = dense_mesh(grid);
        const SimplifyTarget targets[] = {{.vertices = static_cast<std::int64_t>(dense.vertex_count()) / 2},
                                          {.vertices = 0}};
        for (const SimplifyResult& level :
             simplify(grid, {.geometry_weight = seed % 2 ? 3.0f : 0.01f, .smoothing = 2}, targets)) {
            check_topology(level.mesh, mesh_quality(dense));
            check_covers(level.mesh, mask);
            check_hull(level.mesh, dense, mask);
            CHECK(distance_from_to(boundary(dense), boundary(level.mesh)) <= kBoundaryBand + 1e-4);
            CHECK(distance_from_to(boundary(level.mesh), boundary(dense)) <= kBoundaryBand + 1e-4);
        }
    }
}

// A ring one pixel thick around a circle of radius r has room for at least pi / acos(1 - 1 / r) edges: 16 for
// this disc, a few more for one made of pixels. Stairs of every slope become straight.
TEST_CASE("masked images: boundaries become simple") {
    const GridMesh disc = masked_grid(sample_masks(120)[0].mask, Kind::kConstant);
    CHECK(coarse_mesh(disc, 0).vertex_count() <= 55);
    for (const int slope : {1, 2, 3, 7, 20}) {
        const Mask triangle =
            mask_where(80, 60, [&](int x, int y) { return x + slope * y <= 76 && x >= 2 && y >= 1; });
        CHECK(coarse_mesh(masked_grid(triangle, Kind::kConstant), 0).vertex_count() <= 12);
    }
    const Mask rectangle =
        mask_where(60, 40, [](int x, int y) { return x > 3 && x < 50 && y > 5 && y < 30; });
    const BaseMesh mesh = coarse_mesh(masked_grid(rectangle, Kind::kConstant), 0);
    CHECK(mesh.vertex_count() == 4);
    CHECK(mesh_quality(mesh).area == 45 * 23);
}

TEST_CASE("masked images: levels, limits and rebuilt quadrics keep the topology") {
    for (const auto& [name, mask] : sample_masks(48)) {
        INFO(name);
        const GridMesh grid = masked_grid(mask, Kind::kDisc);
        const MeshQuality dense = mesh_quality(dense_mesh(grid));
        const SimplifyTarget targets[] = {{.vertices = 600}, {.vertices = 150}, {.vertices = 20}};
        for (const SimplifyParams& params :
             {plain_params(), plain_params_but([](auto& p) { p.rebuild_quadrics = true; }),
              plain_params_but([](auto& p) { p.max_face_area = 6, p.min_shape = 0.4f; })})
            for (const SimplifyResult& level : simplify(grid, params, targets)) {
                check_topology(level.mesh, dense);
                check_covers(level.mesh, mask);
                if (params.max_face_area == 6) CHECK(mesh_quality(level.mesh).min_shape >= 0.3999);
            }
    }
}

// Large enough for several rounds of tiles with boundaries through them.
TEST_CASE("masked images: tiles keep topology, pixels and distance, the same with any number of threads") {
    const Mask mask = sample_masks(220)[2].mask;  // a ring
    const GridMesh grid = masked_grid(mask);
    const BaseMesh first = coarse_mesh(grid, 1500);
    check_topology(first, mesh_quality(dense_mesh(grid)));
    check_covers(first, mask);
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        const BaseMesh again = coarse_mesh(grid, 1500);
        CHECK(again.position == first.position);
        CHECK(again.faces == first.faces);
    }
}

TEST_CASE("masked images: the same mesh every time, with any number of threads") {
    const Mask mask = sample_masks(150)[4].mask;
    const GridMesh grid = masked_grid(mask);
    const BaseMesh first = coarse_mesh(grid, 400);
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        const BaseMesh again = coarse_mesh(masked_grid(mask), 400);
        CHECK(again.position == first.position);
        CHECK(again.faces == first.faces);
        CHECK(again.feature == first.feature);
    }
}

// If red outside bled in, it would show in the gradients, and so in the places of vertices.
TEST_CASE("masked images: colours outside do not count") {
    const Mask mask = sample_masks(40)[2].mask;
    FeatureImage one = sample_feature(Kind::kGradient, 40, 40), other = one;
    for (std::size_t i = 0; i < other.pixel_count(); ++i)
        if (!mask.contains(i)) std::fill_n(other.pixel(i), 3, 90.0f);
    const BaseMesh a = coarse_mesh(grid_mesh(one, mask), 60), b = coarse_mesh(grid_mesh(other, mask), 60);
    CHECK(a.position == b.position);
    CHECK(a.feature == b.feature);
}
