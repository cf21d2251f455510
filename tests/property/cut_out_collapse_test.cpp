// What must hold for the mesh of any cut-out: its topology, that it covers the mask, and that it stays close.
#include <doctest/doctest.h>

#include <cmath>
#include <map>
#include <numeric>

#include "libcore/base/parallel.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/collapse/masked_rings.h"
#include "libcore/metrics/metrics.h"
#include "libcore/recon/raster.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

GridMesh cut_out(const Mask& mask, Kind kind = Kind::kNoise) {
    return grid_mesh(sample_feature(kind, mask.width, mask.height), mask);
}

BaseMesh dense_mesh(const GridMesh& grid) {
    BaseMesh mesh;
    std::vector<Id> live;
    const RingMesh rings = ring_mesh(grid);
    mesh.faces = ring_faces(rings, live);
    for (const Id v : live) mesh.position.emplace_back(rings[v].x, rings[v].y);
    mesh.feature.resize(3 * live.size());
    return mesh;
}

BaseMesh coarse_mesh(const GridMesh& grid, std::int64_t vertices) {
    return collapse_edges(grid, {}, CollapseTarget{.vertices = vertices}).mesh;
}

// Straight from the rule: two triangles for a cell of four, one for three; n pixels of a bare run make 2 (n -
// 1), a bare pixel alone makes 2. By flags a cell, and not by looking around a pixel.
std::int64_t expected_faces(const Mask& m, double& area) {
    std::int64_t faces = 0;
    std::vector<bool> covered(m.inside.size());
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

double distance_to_segment(const Vec2d& p, const Vec2d& a, const Vec2d& b) {
    const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    return (p - a - t * (b - a)).norm();
}

using Segment = std::pair<Vec2d, Vec2d>;
std::vector<Segment> outline(const BaseMesh& mesh) {
    std::map<std::pair<Id, Id>, int> faces;
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            ++faces[std::minmax(p, q)];
    std::vector<Segment> out;
    for (const auto& [edge, count] : faces)
        if (count == 1)
            out.emplace_back(mesh.position[edge.first].cast<double>(),
                             mesh.position[edge.second].cast<double>());
    return out;
}

// The largest distance from a point of `from`, looked at every quarter of a pixel, to `to`.
double distance_from_to(const std::vector<Segment>& from, const std::vector<Segment>& to) {
    double largest = 0;
    for (const auto& [a, b] : from) {
        const int steps = static_cast<int>(std::ceil(4 * (b - a).norm()));
        for (int k = 0; k <= steps; ++k) {
            const Vec2d p = a + (b - a) * k / steps;
            double least = 1e9;
            for (const auto& [c, d] : to) least = std::min(least, distance_to_segment(p, c, d));
            largest = std::max(largest, least);
        }
    }
    return largest;
}

// At points that lie on no edge, how often the mesh covers each: with no overlap at most once.
int most_faces_over_a_point(const BaseMesh& mesh, int width, int height) {
    int most = 0;
    for (double y = -1 + 1.0 / 7; y < height + 1; y += 2.0 / 7)
        for (double x = -1 + 1.0 / 11; x < width + 1; x += 3.0 / 11) {
            int count = 0;
            for (const Face& f : mesh.faces) {
                const auto side = [&](Id p, Id q) {
                    const Vec2d a = mesh.position[p].cast<double>(), b = mesh.position[q].cast<double>();
                    return (b.y() - a.y()) * (x - a.x()) - (b.x() - a.x()) * (y - a.y()) > 0;
                };
                count += side(f[0], f[1]) && side(f[1], f[2]) && side(f[2], f[0]);
            }
            most = std::max(most, count);
        }
    return most;
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
    for (std::size_t i = 0; i < map.coords.size(); ++i)
        uncovered += mask.contains(i) && map.coords[i].face == kNone;
    CHECK(uncovered == 0);
}

}  // namespace

// Small enough to count by hand. Vertices, faces, components, and Euler characteristic.
TEST_CASE("cut-outs: the dense mesh of small masks") {
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
        const BaseMesh mesh = dense_mesh(cut_out(mask_of(c.rows)));
        const MeshQuality q = mesh_quality(mesh);
        CHECK(mesh.vertex_count() == c.vertices);
        CHECK(mesh.faces.size() == c.faces);
        CHECK(q.components == c.components);
        CHECK(q.euler == c.euler);
        CHECK(q.nonmanifold_edges + q.nonmanifold_vertices + q.flipped_faces == 0);
    }
}

// A pixel with triangles to its left and right and none between them is two vertices.
TEST_CASE("cut-outs: a pinch is split") {
    const GridMesh pinched = cut_out(mask_of({"#.#", "###", "#.#"}));
    // Left: triangles (0,0) (0,1) (1,1) and (0,1) (0,2) (1,1); right likewise: the middle is shared by both.
    REQUIRE(pinched.copies == std::vector<Id>{4});
    const RingMesh rings = ring_mesh(pinched);
    CHECK(rings[4].valence == 3);
    CHECK(rings[9].valence == 3);
    CHECK(rings[9].x == 1);
    CHECK(rings[9].y == 1);
    CHECK(mesh_quality(dense_mesh(pinched)).components == 2);
}

TEST_CASE("cut-outs: the dense mesh has the faces that the cells say, once each") {
    for (const auto& [name, mask] : sample_masks(40)) {
        INFO(name);
        const BaseMesh mesh = dense_mesh(cut_out(mask));
        double area = 0;
        CHECK(static_cast<std::int64_t>(mesh.faces.size()) == expected_faces(mask, area));
        const MeshQuality q = mesh_quality(mesh);
        CHECK(q.area == area);
        CHECK(q.nonmanifold_edges + q.nonmanifold_vertices + q.flipped_faces == 0);
        check_covers(mesh, mask);
    }
}

TEST_CASE("cut-outs: a mask with all pixels inside is meshed as if there were none") {
    const Mask full = mask_where(30, 22, [](int, int) { return true; });
    const BaseMesh with = dense_mesh(cut_out(full)), without = dense_mesh(cut_out(Mask{30, 22, {}}));
    CHECK(with.position == without.position);
    CHECK(with.faces == without.faces);
}

TEST_CASE("cut-outs: topology is kept, every pixel stays covered, and the outline stays close") {
    for (const auto& [name, mask] : sample_masks(40))
        for (const Kind kind : {Kind::kNoise, Kind::kConstant, Kind::kDisc}) {
            const GridMesh grid = cut_out(mask, kind);
            const BaseMesh dense = dense_mesh(grid);
            const MeshQuality dense_quality = mesh_quality(dense);
            for (const std::int64_t vertices : {200, 0}) {
                INFO(name << ", " << name_of(kind) << ", " << vertices << " vertices");
                const BaseMesh mesh = coarse_mesh(grid, vertices);
                check_topology(mesh, dense_quality);
                check_covers(mesh, mask);
                if (vertices != 0) continue;
                CHECK(most_faces_over_a_point(mesh, mask.width, mask.height) <= 1);
                const auto from = outline(dense), to = outline(mesh);
                CHECK(distance_from_to(from, to) <= 0.7501);
                CHECK(distance_from_to(to, from) <= 0.7501);
            }
        }
}

// A circle of radius r within half a pixel to either side needs about pi / acos(1 - 0.75 / r) vertices at the
// least; a tame multiple of that shows that stairs do become straight.
TEST_CASE("cut-outs: outlines become simple") {
    const GridMesh disc = cut_out(sample_masks(120)[0].mask, Kind::kConstant);
    CHECK(coarse_mesh(disc, 0).vertex_count() <= 60);
    const Mask triangle = mask_where(60, 60, [](int x, int y) { return x + 3 * y <= 150 && x >= 2; });
    CHECK(coarse_mesh(cut_out(triangle, Kind::kConstant), 0).vertex_count() <= 12);
    const Mask rectangle =
        mask_where(60, 40, [](int x, int y) { return x > 3 && x < 50 && y > 5 && y < 30; });
    const BaseMesh mesh = coarse_mesh(cut_out(rectangle, Kind::kConstant), 0);
    CHECK(mesh.vertex_count() == 4);
    CHECK(mesh_quality(mesh).area == 45 * 23);
}

TEST_CASE("cut-outs: levels, limits and rebuilt quadrics keep the topology") {
    for (const auto& [name, mask] : sample_masks(48)) {
        INFO(name);
        const GridMesh grid = cut_out(mask, Kind::kDisc);
        const MeshQuality dense = mesh_quality(dense_mesh(grid));
        const CollapseTarget targets[] = {{.vertices = 600}, {.vertices = 150}, {.vertices = 20}};
        for (const CollapseParams& params : {CollapseParams{}, CollapseParams{.rebuild_quadrics = true},
                                             CollapseParams{.max_face_area = 6, .min_shape = 0.4f}})
            for (const CollapseResult& level : collapse_edges(grid, params, targets)) {
                check_topology(level.mesh, dense);
                check_covers(level.mesh, mask);
                if (params.max_face_area == 6) CHECK(mesh_quality(level.mesh).min_shape >= 0.3999);
            }
    }
}

TEST_CASE("cut-outs: the same mesh every time, with any number of threads") {
    const Mask mask = sample_masks(150)[4].mask;
    const GridMesh grid = cut_out(mask);
    const BaseMesh first = coarse_mesh(grid, 400);
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        const BaseMesh again = coarse_mesh(cut_out(mask), 400);
        CHECK(again.position == first.position);
        CHECK(again.faces == first.faces);
        CHECK(again.feature == first.feature);
    }
}

// Red outside would show in the gradients, and so in where vertices go, if it did bleed in.
TEST_CASE("cut-outs: colours outside do not count") {
    const Mask mask = sample_masks(40)[2].mask;
    FeatureImage one = sample_feature(Kind::kGradient, 40, 40), other = one;
    for (std::size_t i = 0; i < other.pixel_count(); ++i)
        if (!mask.contains(i)) std::fill_n(other.pixel(i), 3, 90.0f);
    const BaseMesh a = coarse_mesh(grid_mesh(one, mask), 60), b = coarse_mesh(grid_mesh(other, mask), 60);
    CHECK(a.position == b.position);
    CHECK(a.feature == b.feature);
}
