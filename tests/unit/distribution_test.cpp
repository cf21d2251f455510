#include "libcore/metrics/distribution.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/metrics/quality_distributions.h"
#include "libcore/metrics/triangle_shape.h"
#include "tests/support/meshes.h"

using namespace imgmesh;
using doctest::Approx;
using Counts = std::vector<std::int64_t>;

TEST_CASE("distribution: figures of five numbers, by hand") {
    const float none = std::numeric_limits<float>::quiet_NaN();
    const Distribution d = distribution({4, none, 0, 2, 10, none, 4}, {0, 4, 2});
    CHECK(d.count == 5);
    CHECK(d.mean == Approx(4));
    CHECK(d.deviation == Approx(std::sqrt((0 + 16 + 4 + 36 + 0) / 5.0)));
    CHECK(d.min == 0);
    CHECK(d.max == 10);
    // Sorted: 0 2 4 4 10; the p-th percentile is at place 4 p, counted from 0.
    CHECK(d.p5 == Approx(0.4));
    CHECK(d.p25 == Approx(2));
    CHECK(d.median == Approx(4));
    CHECK(d.p75 == Approx(4));
    CHECK(d.p95 == Approx(8.8));
    CHECK(d.histogram == Counts{1, 3});
    CHECK(d.below == 0);
    CHECK(d.above == 1);
}

// Halves and their bins are exact in binary, so edges are exactly where they seem to be.
TEST_CASE("distribution: edges of bins") {
    const Distribution d = distribution({-0.25f, 0, 0.25f, 0.5f, 1, 1.5f, 1.75f}, {0, 1.5, 3});
    CHECK(d.histogram == Counts{2, 1, 2});
    CHECK(d.below == 1);
    CHECK(d.above == 1);
}

TEST_CASE("distribution: one value is all of its percentiles, none has none") {
    const Distribution one = distribution({7}, {0, 10, 5});
    for (const double figure : {one.mean, one.min, one.p5, one.median, one.p95, one.max}) CHECK(figure == 7);
    CHECK(one.deviation == 0);
    const Distribution none = distribution({}, {0, 10, 5});
    CHECK(none.count == 0);
    CHECK(std::isnan(none.mean));
    CHECK(std::isnan(none.p95));
    CHECK(none.histogram == Counts(5));
}

TEST_CASE("triangle_shape: an equilateral triangle") {
    const TriangleShape s = triangle_shape({0, 0}, {4, 0}, {2, -2 * std::sqrt(3.0f)});
    CHECK(s.edge_ratio == Approx(1));
    CHECK(s.aspect_ratio == Approx(1));
    CHECK(s.radius_ratio == Approx(1));
    CHECK(s.radius_edge_ratio == Approx(1 / std::sqrt(3.0)));
    CHECK(s.shape == Approx(1));
    CHECK(s.min_angle_deg == Approx(60));
}

// Sides 3, 4, 5: area 6, inradius 1, circumradius 2.5, altitude on the longest edge 12/5.
TEST_CASE("triangle_shape: the right triangle 3, 4, 5") {
    const TriangleShape s = triangle_shape({0, 0}, {0, 3}, {4, 0});
    CHECK(s.edge_ratio == Approx(5.0 / 3));
    CHECK(s.aspect_ratio == Approx(std::sqrt(3.0) / 2 * 5 / 2.4));
    CHECK(s.radius_ratio == Approx(0.8));
    CHECK(s.radius_edge_ratio == Approx(2.5 / 3));
    CHECK(s.shape == Approx(24 * std::sqrt(3.0) / 50));
    CHECK(s.min_angle_deg == Approx(36.8699).epsilon(1e-6));
}

// Two right isosceles triangles: every face is alike, and the diagonal's ends have three edges.
TEST_CASE("mesh_distributions: a square") {
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 1}, {1, 1}, {1, 0}, {5, 5}};  // the last is in no face
    mesh.feature.assign(15, 0.0f);
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    MeshDistributions d = mesh_distributions(mesh);
    CHECK(d.valence.count == 4);
    CHECK(d.valence.mean == Approx(2.5));
    CHECK(d.valence.histogram == Counts{2, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    CHECK(d.edge_ratio.count == 2);
    CHECK(d.edge_ratio.max == Approx(std::sqrt(2.0)));
    CHECK(d.aspect_ratio.mean == Approx(std::sqrt(3.0)));  // sqrt(3)/2 sqrt(2) / (sqrt(2)/2)
    CHECK(d.min_angle_deg.median == Approx(45));
    CHECK(d.min_angle_deg.histogram[15] == 2);  // 45 begins the bin [45, 48)
    mesh.faces.push_back({0, 3, 2});            // turned over: no measure, and no new edge
    d = mesh_distributions(mesh);
    CHECK(d.edge_ratio.count == 2);
    CHECK(d.valence.mean == Approx(2.5));
}

TEST_CASE("mesh_distributions: means and extremes are those of mesh_quality") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        const BaseMesh mesh = test::jittered_grid(0, 0, 39, 29, 5, 4, seed);
        const MeshQuality q = mesh_quality(mesh);
        const MeshDistributions d = mesh_distributions(mesh);
        CHECK(d.valence.mean == Approx(q.mean_valence));
        CHECK(d.edge_ratio.mean == Approx(q.mean_edge_ratio).epsilon(1e-6));
        CHECK(d.radius_ratio.mean == Approx(q.mean_radius_ratio).epsilon(1e-6));
        CHECK(d.shape.mean == Approx(q.mean_shape).epsilon(1e-6));
        CHECK(d.shape.min == Approx(q.min_shape).epsilon(1e-6));
        CHECK(d.min_angle_deg.min == Approx(q.min_angle_deg).epsilon(1e-6));
    }
}

// A square of two faces of 8 px^2 each over 5 x 5 pixels; the diagonal's five belong to the lower face id.
TEST_CASE("map_distributions: the trivial map of a square, then one pixel moved") {
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 4}, {4, 4}, {4, 0}};
    mesh.feature.assign(12, 0.0f);
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    PixelMap map = trivial_map(mesh, 5, 5);
    MapDistributions d = map_distributions(mesh, map);
    CHECK(d.patch_per_area.max == Approx(15.0 / 8));
    CHECK(d.patch_per_area.min == Approx(10.0 / 8));
    CHECK(d.empty_patches == 0);
    CHECK(d.displacement.count == 25);
    CHECK(d.displacement.max == Approx(0));
    CHECK(d.jump.count == 40);
    CHECK(d.jump.min == Approx(1));
    CHECK(d.jump.max == Approx(1));

    map.row(0)[0] = map.row(0)[2];  // the corner goes to (2, 0): 2 away, 1 from (1, 0), sqrt 5 from (0, 1)
    d = map_distributions(mesh, map);
    CHECK(d.displacement.max == Approx(2));
    CHECK(d.displacement.mean == Approx(2.0 / 25));
    CHECK(d.jump.max == Approx(std::sqrt(5.0)));
    CHECK(d.jump.max == Approx(map_quality(mesh, map).max_jump));

    for (PixelCoord& c : map)
        if (c.face == 1) c = {};  // outside
    d = map_distributions(mesh, map);
    CHECK(d.empty_patches == 1);
    CHECK(d.patch_per_area.min == 0);
    CHECK(d.displacement.count == 14);
}
