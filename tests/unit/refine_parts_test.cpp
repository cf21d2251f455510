// Parts of the refinement: spans, sums over pixels, and what vertices may do.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "libcore/mesh/face_field.h"
#include "libcore/mesh/touched_faces.h"
#include "libcore/mesh/vertex_coloring.h"
#include "libcore/metrics/metrics.h"
#include "libcore/refine/face_spans.h"
#include "libcore/refine/pixel_sums.h"
#include "libcore/refine/refine_vertices.h"
#include "libcore/refine/vertex_tiles.h"
#include "tests/support/meshes.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

Corner corner_of(const BaseMesh& mesh, Id v) {
    return {mesh.position[v], Vec3f(mesh.feature_of(v))};
}

BaseMesh colored_grid(int width, int height, int columns, int rows, std::uint32_t seed) {
    BaseMesh mesh = jittered_grid(width > 1 ? 0 : -0.5, height > 1 ? 0 : -0.5, width > 1 ? width - 1 : 0.5,
                                  height > 1 ? height - 1 : 0.5, columns, rows, seed);
    std::mt19937 random(seed);
    for (float& f : mesh.feature) f = static_cast<float>(random() % 100);
    return mesh;
}

}  // namespace

// Vertices of one class are moved at the same time, so none may see another.
TEST_CASE("vertex classes: every vertex that has a face is in one, and no face has two of a class") {
    for (std::uint32_t seed = 0; seed < 5; ++seed) {
        BaseMesh mesh = jittered_grid(0, 0, 60, 40, 20, 13, seed);
        for (std::size_t f = 0; f < 40; ++f) mesh.faces[f] = {kNone, kNone, kNone};
        std::vector<int> faces_of(mesh.vertex_count(), 0);
        for (const Face& face : mesh.faces)
            for (const Id v : face)
                if (face[0] != kNone) ++faces_of[v];
        const auto classes = vertex_coloring(mesh.faces, mesh.vertex_count());
        CHECK(classes.size() <= 9);
        std::vector<Id> class_of(mesh.vertex_count(), kNone);
        for (Id c = 0; c < classes.size(); ++c)
            for (const Id v : classes[c]) {
                CHECK(class_of[v] == kNone);
                class_of[v] = c;
            }
        for (Id v = 0; v < mesh.vertex_count(); ++v) CHECK((class_of[v] != kNone) == (faces_of[v] > 0));
        for (const auto& [a, b, c] : mesh.faces)
            if (a != kNone)
                CHECK(
                    (class_of[a] != class_of[b] && class_of[b] != class_of[c] && class_of[c] != class_of[a]));
    }
    // One face, and nothing at all.
    CHECK(vertex_coloring(std::vector<Face>{{0, 1, 2}}, 3).size() == 3);
    CHECK(vertex_coloring({}, 0).empty());
}

// The tiles of one class change at the same time, so none may see another. Some faces are longer than a tile.
TEST_CASE("vertex tiles: every vertex that has a face is in one, and no face has two tiles of a class") {
    for (const auto& [columns, rows] : {std::pair{40, 30}, {4, 3}, {1, 1}}) {
        BaseMesh mesh = jittered_grid(0, 0, 400, 300, columns, rows, 5);
        if (mesh.faces.size() > 20) mesh.faces[7] = {kNone, kNone, kNone};
        const VertexTiles tiles(mesh.faces, mesh.position);
        std::vector<Id> tile_of(mesh.vertex_count(), kNone);
        for (Id tile = 0; tile < tiles.members().size(); ++tile)
            for (const Id v : tiles.members()[tile]) {
                CHECK(tile_of[v] == kNone);
                tile_of[v] = tile;
            }
        std::vector<Id> class_of(tiles.members().size(), kNone);
        for (Id c = 0; c < tiles.classes().size(); ++c)
            for (const Id tile : tiles.classes()[c]) class_of[tile] = c;
        for (const auto& [a, b, c] : mesh.faces) {
            if (a == kNone) continue;
            for (const auto& [u, v] : {std::pair{a, b}, {b, c}, {c, a}}) {
                REQUIRE(tile_of[u] != kNone);
                CHECK(class_of[tile_of[u]] != kNone);
                CHECK((tile_of[u] == tile_of[v]) == (class_of[tile_of[u]] == class_of[tile_of[v]]));
            }
        }
        std::vector<int> calls(mesh.vertex_count(), 0);
        tiles.for_each([&](Id v) { ++calls[v]; });
        CHECK(calls == std::vector<int>(mesh.vertex_count(), 1));
    }
}

// What was found before holds for no face that has changed or is new.
TEST_CASE("touched faces: those of a ring, and those that did not exist") {
    TouchedFaces touched(4);
    OneRing ring;
    ring.faces = 2;
    ring.face[0] = 1;
    ring.face[1] = 3;
    CHECK(!touched.has_any(ring));
    touched.add(Id{3});
    CHECK(touched.has_any(ring));
    CHECK(!touched.has(1));
    touched.add(ring);
    CHECK(touched.has(1));
    CHECK(!touched.has(0));
    CHECK(touched.has(4));
    CHECK(!touched.has(kNone));
    touched.add(4);
    touched.add(kNone);
    CHECK(!touched.has(2));
}

// Grids whose vertices lie on pixel centres, lines through centres, slivers: each pixel counts exactly once.
TEST_CASE("spans: the faces of a mesh share out all pixels") {
    for (const auto& size : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 3}, {17, 11}, {40, 30}})
        for (std::uint32_t seed = 0; seed < 12; ++seed) {
            const int w = size.first, h = size.second;
            INFO(w << " x " << h << " seed " << seed);
            BaseMesh mesh = colored_grid(w, h, w > 6 ? w / 3 : 1, h > 6 ? h / 3 : 1, seed);
            if (seed % 3 == 0)  // onto the centres
                for (Vec2f& p : mesh.position)
                    if (w > 1 && h > 1) p = Vec2f(std::floor(p.x()), std::floor(p.y()));
            std::vector<int> count(static_cast<std::size_t>(w * h), 0);
            for (const auto& [a, b, c] : mesh.faces)
                for_each_span(mesh.position[a], mesh.position[b], mesh.position[c], w, h,
                              [&](int y, int begin, int end) {
                                  REQUIRE(begin >= 0);
                                  REQUIRE(end <= w);
                                  for (int x = begin; x < end; ++x)
                                      ++count[static_cast<std::size_t>(y * w + x)];
                              });
            CHECK(count == std::vector<int>(count.size(), 1));
        }
}

// In whole numbers, for the largest images: a quotient in floating point may not cross a pixel's centre.
TEST_CASE("spans: begin and end at the first pixel that is not left of an edge") {
    constexpr int kSide = 65500, kUnits = 32 * (kSide - 1);
    std::mt19937 random(3);
    using Point = std::array<std::int64_t, 2>;  // in 1/32 px
    const auto first_pixel = [](const Point& p, const Point& q, std::int64_t y) {
        const std::int64_t dx = q[0] - p[0], dy = q[1] - p[1];  // dy > 0
        const std::int64_t numerator = p[0] * dy + (32 * y - p[1]) * dx, denominator = 32 * dy;
        return numerator / denominator + (numerator % denominator > 0);
    };
    for (int k = 0; k < 60; ++k) {
        // Tall thin ones, whose edges pass close by centres; every third one has whole coordinates.
        std::array<Point, 3> p;
        for (Point& v : p) {
            v[0] = static_cast<std::int64_t>(random() % kUnits);
            v[1] = static_cast<std::int64_t>(random() % kUnits);
            if (k % 3 == 0) v[0] &= ~31, v[1] &= ~31;
        }
        if (k % 2 == 0) p[2][0] = p[1][0] + 40, p[2][1] = p[1][1];
        std::sort(p.begin(), p.end(), [](const Point& a, const Point& b) { return a[1] < b[1]; });
        const auto at = [&](std::size_t i) {
            return Vec2f(static_cast<float>(p[i][0]) / 32, static_cast<float>(p[i][1]) / 32);
        };
        const bool turned = signed_area2(at(0), at(1), at(2)) < 0;
        if (signed_area2(at(0), at(1), at(2)) == 0) continue;
        std::int64_t wrong = 0, rows = 0;
        for_each_span(at(0), turned ? at(2) : at(1), turned ? at(1) : at(2), kSide, kSide,
                      [&](int y, int begin, int end) {
                          const std::int64_t full = first_pixel(p[0], p[2], y);
                          const std::int64_t part =
                              32 * y >= p[1][1] ? first_pixel(p[1], p[2], y) : first_pixel(p[0], p[1], y);
                          wrong += begin != std::min(full, part) || end != std::max(full, part);
                          ++rows;
                      });
        CHECK(wrong == 0);
        CHECK(rows <= p[2][1] / 32 - p[0][1] / 32 + 1);
    }
}

namespace {

// A new vertex's weight: in the middle of the face (edge -1), or at `at` on the edge opposite a corner.
double hat(const double (&w)[3], int edge, double at) {
    if (edge < 0) return 3 * std::min({w[0], w[1], w[2]});
    return std::min(w[(edge + 2) % 3] / at, w[(edge + 1) % 3] / (1 - at));
}

}  // namespace

// Against sums in double, pixel by pixel, for faces from a sliver to hundreds of rows.
TEST_CASE("sums over the pixels of a face") {
    const FeatureImage picture = sample_feature(Kind::kNoise, 70, 90);
    Mask mask{70, 90, std::vector<std::uint8_t>(70 * 90, 1)};
    for (std::size_t i = 0; i < mask.values.size(); i += 3) mask.values[i] = 0;
    const std::array<float, 3> at = {0.5f, 0.2f, 0.7f};
    for (const Mask& inside : {Mask(), mask})
        for (const auto& [columns, rows, seed] : {std::tuple{1, 1, 1u}, {7, 9, 2u}, {20, 25, 3u}}) {
            const ImagePlanes planes(picture, inside);
            const BaseMesh mesh = colored_grid(70, 90, columns, rows, seed);
            double whole = 0, expected_whole = 0;
            for (const Face& face : mesh.faces) {
                const Corner corner[3] = {corner_of(mesh, face[0]), corner_of(mesh, face[1]),
                                          corner_of(mesh, face[2])};
                double ee = 0, ww[3][3] = {}, hh[4] = {};
                Vec3d we[3], he[4];
                for (Vec3d& v : we) v.setZero();
                for (Vec3d& v : he) v.setZero();
                for_each_span(corner[0].position, corner[1].position, corner[2].position, 70, 90,
                              [&](int y, int begin, int end) {
                                  for (int x = begin; x < end; ++x) {
                                      if (!inside.empty() && !inside.contains(as_index(y * 70 + x))) continue;
                                      const Vec2f p(static_cast<float>(x), static_cast<float>(y));
                                      double w[3];
                                      Vec3d e = -Vec3f(picture.pixel(x, y)).cast<double>();
                                      for (std::size_t i = 0; i < 3; ++i) {
                                          w[i] = signed_area2(p, corner[(i + 1) % 3].position,
                                                              corner[(i + 2) % 3].position) /
                                                 signed_area2(corner[0].position, corner[1].position,
                                                              corner[2].position);
                                          e += w[i] * corner[i].color.cast<double>();
                                      }
                                      ee += e.squaredNorm();
                                      for (int i = 0; i < 3; ++i) {
                                          we[i] += w[i] * e;
                                          for (int j = 0; j < 3; ++j) ww[i][j] += w[i] * w[j];
                                      }
                                      for (int i = -1; i < 3; ++i) {
                                          const double h = hat(w, i, i < 0 ? 0 : at[as_index(i)]);
                                          hh[i + 1] += h * h;
                                          he[i + 1] += h * e;
                                      }
                                  }
                              });
                const FaceSums got = face_sums(planes, corner[0], corner[1], corner[2]);
                CHECK(static_cast<float>(squared_error(planes, corner[0], corner[1], corner[2])) == got.ee);
                const double scale = 1 + std::sqrt(ee);
                CHECK(got.ee == doctest::Approx(ee).epsilon(1e-5));
                for (int i = 0; i < 3; ++i) {
                    CHECK((got.we[i].cast<double>() - we[i]).norm() < 1e-3 * scale);
                    CHECK(std::abs(got.square[i] - ww[i][i]) < 1e-3);
                    CHECK(std::abs(got.product[i] - ww[(i + 1) % 3][(i + 2) % 3]) < 1e-3);
                }
                const FaceHats found = face_hats(planes, corner[0], corner[1], corner[2], at);
                for (std::size_t i = 0; i < 4; ++i) {
                    const HatSums& sums = i == 0 ? found.center : found.edge[i - 1];
                    CHECK(std::abs(sums.hh - hh[i]) < 1e-3);
                    CHECK((sums.he.cast<double>() - he[i]).norm() < 1e-3 * scale);
                }
                whole += got.ee;
                expected_whole += ee;
            }
            CHECK(whole == doctest::Approx(expected_whole).epsilon(1e-6));
        }
}

// Drawings are linear in a corner's colour.
TEST_CASE("sums over the pixels of a face follow its colours") {
    const ImagePlanes planes(sample_feature(Kind::kNoise, 70, 90));
    Corner a{{3, 5}, {10, 20, 30}}, b{{20, 80}, {-5, 0, 40}}, c{{60, 30}, {70, 5, 5}};
    FaceSums sums = face_sums(planes, a, b, c);
    const Vec3f change(4, -30, 12);
    sums.shift(1, change.cast<double>());
    b.color += change;
    const FaceSums fresh = face_sums(planes, a, b, c);
    CHECK(sums.ee == doctest::Approx(fresh.ee).epsilon(1e-5));
    for (int i = 0; i < 3; ++i) CHECK((sums.we[i] - fresh.we[i]).norm() < 1e-3 * std::sqrt(fresh.ee));
}

// Both drawings of four corners agree on the rim, and differ by a hat whose tip is where the diagonals cross.
TEST_CASE("sums of a hat say what a flip changes") {
    const ImagePlanes planes(sample_feature(Kind::kNoise, 70, 90));
    const Corner p{{4, 30}, {10, 20, 30}}, a{{30, 70}, {-5, 0, 40}}, q{{64, 50}, {70, 5, 5}},
        b{{24, 10}, {0, 60, -9}};
    const auto area2 = [](const Corner& u, const Corner& v, const Corner& w) {
        return signed_area2(u.position, v.position, w.position);
    };
    const auto share = [](double first, double second) {
        return static_cast<float>(first / (first + second));
    };
    const float t = share(area2(p, a, q), area2(q, b, p)), s = share(area2(p, a, b), area2(q, b, a));
    const Vec3d change = ((1 - s) * p.color + s * q.color - (1 - t) * a.color - t * b.color).cast<double>();
    const HatSums first = face_hats(planes, p, a, b, {t, 0.5f, 0.5f}).edge[0],
                  second = face_hats(planes, q, b, a, {1 - t, 0.5f, 0.5f}).edge[0];
    const double before = squared_error(planes, p, a, b) + squared_error(planes, q, b, a),
                 after = squared_error(planes, p, a, q) + squared_error(planes, q, b, p);
    CHECK(std::abs(after - before) > 1000);
    const Vec3d he = (first.he + second.he).cast<double>();
    CHECK(2 * change.dot(he) + (first.hh + second.hh) * change.squaredNorm() ==
          doctest::Approx(after - before).epsilon(1e-4));
}

TEST_CASE("refine vertices: corners are fixed, vertices of the sides slide, others are free") {
    const RefineVertices vertices(colored_grid(60, 40, 5, 4, 7));
    for (Id v = 0; v < vertices.position.size(); ++v) {
        const bool x = vertices.position[v].x() == 0 || vertices.position[v].x() == 59;
        const bool y = vertices.position[v].y() == 0 || vertices.position[v].y() == 39;
        CHECK(vertices.fixed[v] == ((x ? kFixedX : 0) | (y ? kFixedY : 0)));
    }
}

// An L: the vertices of its inner corner and of the two sides there are not on a side of the bounding box.
TEST_CASE("refine vertices: a boundary inside the bounding box is fixed") {
    BaseMesh mesh = jittered_grid(0, 0, 40, 40, 4, 4, 3);
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i)
            mesh.position[static_cast<std::size_t>(j * 5 + i)] =
                Vec2f(static_cast<float>(10 * i), static_cast<float>(10 * j));
    std::erase_if(mesh.faces, [&](const Face& face) {
        const Vec2f c = mesh.position[face[0]] + mesh.position[face[1]] + mesh.position[face[2]];
        return c.x() > 60 && c.y() > 60;
    });
    const RefineVertices l(mesh);
    const auto fixed_at = [&](int i, int j) { return l.fixed[static_cast<std::size_t>(j * 5 + i)]; };
    CHECK(fixed_at(2, 2) == (kFixedX | kFixedY));  // the inner corner
    CHECK(fixed_at(3, 2) == (kFixedX | kFixedY));  // straight on, yet inside the box
    CHECK(fixed_at(2, 3) == (kFixedX | kFixedY));
    CHECK(fixed_at(4, 2) == (kFixedX | kFixedY));  // an end of the L
    CHECK(fixed_at(1, 4) == kFixedY);
    CHECK(fixed_at(0, 1) == kFixedX);
    CHECK(fixed_at(1, 1) == RefineVertices::kFree);
}

// The same vertices and faces under other numbers.
TEST_CASE("refine vertices: a mesh is numbered downwards") {
    BaseMesh mesh;
    mesh.position = {{5, 9}, {4, 0}, {9, 9}, {0, 9}, {2, 0}};
    for (Id v = 0; v < 5; ++v) mesh.feature.insert(mesh.feature.end(), {float(v), 0, 0});
    mesh.faces = {{0, 2, 1}, {1, 4, 0}, {3, 0, 4}};
    const BaseMesh out = numbered_downwards(mesh);
    CHECK(out.position == std::vector<Vec2f>{{2, 0}, {4, 0}, {0, 9}, {5, 9}, {9, 9}});
    for (Id v = 0; v < 5; ++v) CHECK(out.feature_of(v)[0] == std::array{4.f, 1.f, 3.f, 0.f, 2.f}[v]);
    CHECK(out.faces == std::vector<Face>{{1, 0, 3}, {2, 3, 0}, {3, 4, 1}});
}

// What comes out is what is alive, numbered anew.
TEST_CASE("refine vertices: places are taken again, and compact() leaves out what has gone") {
    const BaseMesh start = colored_grid(30, 20, 3, 2, 5);
    RefineVertices vertices(start);
    EditMesh mesh = refine_faces(start);
    const BaseMesh same = compact(mesh, vertices);
    CHECK(same.position == start.position);
    CHECK(same.feature == start.feature);
    CHECK(same.faces == start.faces);
    OneRing ring;
    for (Id v = 0; v < start.vertex_count(); ++v) {  // rings inside begin with the last face
        REQUIRE(mesh.ring(v, ring));
        if (ring.closed)
            CHECK(ring.face[0] == *std::max_element(ring.face.begin(), ring.face.begin() + ring.faces));
    }
    REQUIRE(mesh.ring(5, ring));
    mesh.collapse(ring, ring.vertex[0]);
    BaseMesh out = compact(mesh, vertices);
    CHECK(out.vertex_count() == 11);
    CHECK(out.position[5] == start.position[6]);
    const MeshQuality q = mesh_quality(out);
    CHECK(q.euler == 1);
    CHECK(q.nonmanifold_edges + q.nonmanifold_vertices == 0);

    const Id face = static_cast<Id>(
        std::find_if(mesh.faces().begin(), mesh.faces().end(), [](const Face& f) { return f[0] != kNone; }) -
        mesh.faces().begin());
    CHECK(mesh.split_face(face) == 5);
    vertices.set(5, {1, 2}, {3, 4, 5}, kFixedX);
    vertices.set(mesh.split_face(face), {6, 7}, {8, 9, 10}, RefineVertices::kFree);
    out = compact(mesh, vertices);
    CHECK(out.vertex_count() == 13);
    CHECK(out.position[5] == Vec2f(1, 2));
    CHECK(out.position[12] == Vec2f(6, 7));
    CHECK(Vec3f(out.feature_of(12)) == Vec3f(8, 9, 10));
    CHECK(vertices.fixed[5] == kFixedX);
}
