#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "libcore/base/error.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "tests/support/meshes.h"

using namespace imgmesh;
using doctest::Approx;

namespace {

BaseMesh mesh_of(std::vector<Vec2f> position, std::vector<Face> faces) {
    BaseMesh mesh;
    mesh.feature.assign(position.size() * 3, 0.0f);
    mesh.position = std::move(position);
    mesh.faces = std::move(faces);
    return mesh;
}

}  // namespace

TEST_CASE("mesh_quality: an equilateral triangle is the best there is") {
    const MeshQuality q = mesh_quality(mesh_of({{0, 0}, {4, 0}, {2, -2 * std::sqrt(3.0f)}}, {{0, 1, 2}}));
    CHECK(q.mean_edge_ratio == Approx(1));
    CHECK(q.mean_radius_ratio == Approx(1));
    CHECK(q.mean_shape == Approx(1));
    CHECK(q.min_shape == Approx(1));
    CHECK(q.min_angle_deg == Approx(60));
    CHECK(q.area == Approx(4 * std::sqrt(3.0)));
    CHECK(q.flipped_faces == 0);
    CHECK(q.mean_valence == Approx(2));
}

// Legs 1, 1: inradius (2 - sqrt 2) / 2, circumradius sqrt(2) / 2, q = 4 sqrt(3) / 2 / (1 + 1 + 2).
TEST_CASE("mesh_quality: a right isosceles triangle") {
    const MeshQuality q = mesh_quality(mesh_of({{0, 0}, {0, 1}, {1, 0}}, {{0, 1, 2}}));
    CHECK(q.mean_edge_ratio == Approx(std::sqrt(2.0)));
    CHECK(q.mean_radius_ratio == Approx(2 * (std::sqrt(2.0) - 1)));
    CHECK(q.mean_shape == Approx(std::sqrt(3.0) / 2));
    CHECK(q.min_angle_deg == Approx(45));
    CHECK(q.area == Approx(0.5));
}

TEST_CASE("mesh_quality: two triangles glued along an edge") {
    const MeshQuality q = mesh_quality(mesh_of({{0, 0}, {0, 1}, {1, 1}, {1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
    CHECK(q.vertices == 4);
    CHECK(q.faces == 2);
    CHECK(q.edges == 5);
    CHECK(q.boundary_edges == 4);
    CHECK(q.components == 1);
    CHECK(q.euler == 1);
    CHECK(q.nonmanifold_edges == 0);
    CHECK(q.nonmanifold_vertices == 0);
    CHECK(q.mean_valence == Approx(2.5));
    CHECK(q.area == Approx(1));
}

TEST_CASE("mesh_quality: a bow tie has one vertex with two fans") {
    const MeshQuality q =
        mesh_quality(mesh_of({{0, 0}, {0, 2}, {1, 1}, {2, 0}, {2, 2}}, {{0, 1, 2}, {2, 4, 3}}));
    CHECK(q.nonmanifold_vertices == 1);
    CHECK(q.nonmanifold_edges == 0);
    CHECK(q.components == 2);
    CHECK(q.euler == 1);
    CHECK(q.flipped_faces == 0);
}

TEST_CASE("mesh_quality: a flipped face, and what it does to its edges") {
    const MeshQuality q = mesh_quality(mesh_of({{0, 0}, {0, 1}, {1, 1}, {1, 0}}, {{0, 1, 2}, {0, 3, 2}}));
    CHECK(q.flipped_faces == 1);
    CHECK(q.nonmanifold_edges == 1);  // both faces run from 2 to 0
    CHECK(q.area == Approx(0));
    CHECK(q.min_shape == 0);
    CHECK(q.min_angle_deg == 0);
    CHECK(q.mean_edge_ratio == Approx(std::sqrt(2.0)));  // of the good face
}

TEST_CASE("mesh_quality: three faces at one edge") {
    const MeshQuality q =
        mesh_quality(mesh_of({{0, 0}, {0, 1}, {1, 1}, {1, 0}, {2, 0}}, {{0, 1, 2}, {0, 2, 3}, {0, 2, 4}}));
    CHECK(q.nonmanifold_edges == 1);
    CHECK(q.components == 1);
}

// A square ring: inner and outer square, two triangles a side.
TEST_CASE("mesh_quality: a disc with a hole has Euler number 0, an unused vertex does not count") {
    BaseMesh ring = mesh_of({{0, 0}, {0, 3}, {3, 3}, {3, 0}, {1, 1}, {1, 2}, {2, 2}, {2, 1}, {9, 9}}, {});
    for (Id k = 0; k < 4; ++k) {
        const Id next = (k + 1) % 4;
        ring.faces.push_back({k, next, next + 4});
        ring.faces.push_back({k, next + 4, k + 4});
    }
    const MeshQuality q = mesh_quality(ring);
    CHECK(q.vertices == 9);
    CHECK(q.euler == 0);
    CHECK(q.components == 1);
    CHECK(q.boundary_edges == 8);
    CHECK(q.nonmanifold_vertices == 0);
    CHECK(q.flipped_faces == 0);
    CHECK(q.area == Approx(8));
}

TEST_CASE("mesh_quality: an empty mesh is all zeros") {
    const MeshQuality q = mesh_quality({});
    CHECK(q.euler == 0);
    CHECK(q.min_shape == 0);
    CHECK(q.mean_valence == 0);
}

TEST_CASE("map_quality: the trivial map is the identity") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        const BaseMesh mesh = test::jittered_grid(0, 0, 39, 29, 5, 4, seed);
        const MapQuality q = map_quality(mesh, trivial_map(mesh, 40, 30));
        CHECK(q.pixels == 1200);
        CHECK(q.unmapped == 0);
        CHECK(q.outside_simplex == 0);
        CHECK(q.flipped_triangles == 0);
        CHECK(q.min_area2 == Approx(1).epsilon(1e-5));
        CHECK(q.max_jump == Approx(1).epsilon(1e-5));
        CHECK(q.max_displacement < 1e-5);
    }
}

// One face holds everything, so a pixel is moved by setting its weights.
TEST_CASE("map_quality: a pixel moved across, one unmapped, one outside the simplex") {
    const BaseMesh mesh = mesh_of({{0, 0}, {0, 8}, {8, 0}}, {{0, 1, 2}});
    PixelMap map = trivial_map(mesh, 3, 3);
    const auto put = [](double x, double y) {
        return PixelCoord{0, static_cast<float>(y / 8), static_cast<float>(x / 8)};
    };
    CHECK(map.row(1)[1] == put(1, 1));

    map.row(1)[1] = put(2.5, 1);  // beyond its right neighbour (2, 1)
    MapQuality q = map_quality(mesh, map);
    // Right of the middle, the cell above has two triangles with both (1,1) and (2,1), the one below as well.
    CHECK(q.flipped_triangles == 4);
    CHECK(q.min_area2 == Approx(-0.5));
    CHECK(q.max_jump == Approx(2.5));
    CHECK(q.max_displacement == Approx(1.5));
    CHECK(q.mean_displacement == Approx(1.5 / 9));
    CHECK(q.outside_simplex == 0);

    map.row(1)[1].face = kNone;  // every triangle that held it is removed, one is left in each cell
    q = map_quality(mesh, map);
    CHECK(q.pixels == 9);
    CHECK(q.unmapped == 1);
    CHECK(q.flipped_triangles == 0);
    CHECK(q.min_area2 == Approx(1));
    CHECK(q.max_jump == Approx(1));
    q = map_quality(mesh, map, /*has_mask=*/true);
    CHECK(q.pixels == 8);
    CHECK(q.unmapped == 0);

    map.row(1)[1] = {1, 0, 0};
    CHECK(map_quality(mesh, map, true).unmapped == 1);
    for (const PixelCoord& bad : {PixelCoord{0, -0.1f, 0.2f}, PixelCoord{0, 0.6f, 0.5f},
                                  PixelCoord{0, std::numeric_limits<float>::quiet_NaN(), 0.0f},
                                  PixelCoord{0, std::numeric_limits<float>::infinity(), 0.0f}}) {
        map.row(1)[1] = bad;
        CHECK(map_quality(mesh, map).outside_simplex == 1);
        CHECK(std::isfinite(map_quality(mesh, map).mean_displacement));
    }
}

TEST_CASE("map_quality: an image of one row has steps but no triangles") {
    const BaseMesh mesh = test::jittered_grid(0, -0.5, 9, 0.5, 2, 1, 1);
    const MapQuality q = map_quality(mesh, trivial_map(mesh, 10, 1));
    CHECK(q.min_area2 == 1);
    CHECK(q.max_jump == Approx(1).epsilon(1e-5));
    CHECK(q.unmapped == 0);
}

TEST_CASE("map_rms: features linear in position are exact, an offset shows as itself") {
    BaseMesh mesh = test::jittered_grid(0, 0, 39, 29, 5, 4, 3);
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        mesh.feature_of(v)[0] = mesh.position[v].x();
        mesh.feature_of(v)[1] = mesh.position[v].y() * 2;
        mesh.feature_of(v)[2] = 7;
    }
    FeatureImage reference{40, 30, 3, std::vector<float>(40 * 30 * 3)};
    for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
        reference.pixel(i)[0] = float(i % 40);
        reference.pixel(i)[1] = float(i / 40) * 2;
        reference.pixel(i)[2] = 7;
    }
    PixelMap map = trivial_map(mesh, 40, 30);
    CHECK(map_rms(mesh, map, reference) < 1e-5);
    for (std::size_t i = 0; i < reference.pixel_count(); ++i) {
        reference.pixel(i)[0] += 3;
        reference.pixel(i)[2] -= 4;
    }
    CHECK(map_rms(mesh, map, reference) == Approx(5).epsilon(1e-5));
    for (PixelCoord& c : map) c = {};
    CHECK(map_rms(mesh, map, reference) == 0);
    reference.height = 29;
    CHECK_THROWS_AS(map_rms(mesh, map, reference), Error);
    reference.height = 30;
    mesh.channels = 1;
    CHECK_THROWS_AS(map_rms(mesh, map, reference), Error);
}
