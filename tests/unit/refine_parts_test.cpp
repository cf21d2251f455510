// Parts of the refinement: spans, sums over pixels, and the editable mesh.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/face_field.h"
#include "libcore/mesh/vertex_coloring.h"
#include "libcore/metrics/metrics.h"
#include "libcore/refine/face_spans.h"
#include "libcore/refine/pixel_sums.h"
#include "libcore/refine/refine_mesh.h"
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

// Neighbours as the mesh keeps them against those found from the faces alone.
void check_links(const RefineMesh& mesh) {
    std::vector<Face> live;
    std::vector<Id> number(mesh.faces.size(), kNone);
    for (Id f = 0; f < mesh.faces.size(); ++f)
        if (mesh.live_face(f)) {
            number[f] = static_cast<Id>(live.size());
            Face across = mesh.across[f];
            live.push_back(across);
        }
    for (Face& across : live)
        for (Id& f : across)
            if (f != kNone) f = number[f];
    CHECK(live == face_neighbors(mesh.compact()));
    Star star;
    for (Id v = 0; v < mesh.position.size(); ++v) {
        if (!mesh.live_vertex(v) || !mesh.star(v, star)) continue;
        for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k) {
            CHECK(mesh.faces[star.face[k]][star.corner[k]] == v);
            if (k > 0)  // counter-clockwise: the last corner of one is the next corner of the following
                CHECK(mesh.faces[star.face[k - 1]][(star.corner[k - 1] + 2u) % 3] ==
                      mesh.faces[star.face[k]][(star.corner[k] + 1u) % 3]);
        }
    }
}

void check_sound(const RefineMesh& mesh, double area) {
    const MeshQuality q = mesh_quality(mesh.compact());
    CHECK(q.vertices == static_cast<std::int64_t>(mesh.vertex_count()));
    CHECK(q.euler == 1);
    CHECK(q.nonmanifold_edges + q.nonmanifold_vertices == 0);
    CHECK(q.area == area);
    check_links(mesh);
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

// Grids whose vertices lie on pixel centres, lines through centres, slivers: each pixel counts exactly once.
TEST_CASE("spans: the faces of a mesh share out all pixels") {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 3}, {17, 11}, {40, 30}})
        for (std::uint32_t seed = 0; seed < 12; ++seed) {
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

// Against sums in double, pixel by pixel, for faces from a sliver to hundreds of rows.
TEST_CASE("sums over the pixels of a face") {
    const FeatureImage picture = sample_feature(Kind::kNoise, 70, 90);
    const ImagePlanes planes(picture);
    for (const auto& [columns, rows, seed] : {std::tuple{1, 1, 1u}, {7, 9, 2u}, {20, 25, 3u}}) {
        const BaseMesh mesh = colored_grid(70, 90, columns, rows, seed);
        double whole = 0, expected_whole = 0;
        for (const Face& face : mesh.faces) {
            const Corner corner[3] = {corner_of(mesh, face[0]), corner_of(mesh, face[1]),
                                      corner_of(mesh, face[2])};
            FaceSums want;
            float worst = -1;
            for_each_span(
                corner[0].position, corner[1].position, corner[2].position, 70, 90,
                [&](int y, int begin, int end) {
                    for (int x = begin; x < end; ++x) {
                        const Vec2f p(static_cast<float>(x), static_cast<float>(y));
                        double w[3];
                        Vec3d e = -Vec3f(picture.pixel(x, y)).cast<double>();
                        for (std::size_t i = 0; i < 3; ++i) {
                            w[i] =
                                signed_area2(p, corner[(i + 1) % 3].position, corner[(i + 2) % 3].position) /
                                signed_area2(corner[0].position, corner[1].position, corner[2].position);
                            e += w[i] * corner[i].color.cast<double>();
                        }
                        want.ee += e.squaredNorm();
                        worst = std::max(worst, static_cast<float>(e.squaredNorm()));
                        for (int i = 0; i < 3; ++i) {
                            want.we[i] += w[i] * e;
                            for (int j = 0; j < 3; ++j) want.ww[i][j] += w[i] * w[j];
                        }
                    }
                });
            const FaceSums got = face_sums(planes, corner[0], corner[1], corner[2]);
            const CornerSums one = corner_sums(planes, corner[0], corner[1], corner[2]);
            CHECK(squared_error(planes, corner[0], corner[1], corner[2]) == one.ee);
            const double scale = 1 + std::sqrt(want.ee);
            CHECK(got.ee == doctest::Approx(want.ee).epsilon(1e-5));
            CHECK(one.ee == doctest::Approx(want.ee).epsilon(1e-5));
            CHECK(one.ww == doctest::Approx(want.ww[0][0]).epsilon(1e-4));
            CHECK((one.we - want.we[0]).norm() < 1e-3 * scale);
            for (int i = 0; i < 3; ++i) {
                CHECK((got.we[i] - want.we[i]).norm() < 1e-3 * scale);
                for (int j = 0; j < 3; ++j) CHECK(std::abs(got.ww[i][j] - want.ww[i][j]) < 1e-3);
            }
            const WorstPixel pixel = worst_pixel(planes, corner[0], corner[1], corner[2]);
            CHECK((pixel.x < 0) == (worst < 0));
            if (worst >= 0) CHECK(pixel.error == doctest::Approx(worst).epsilon(1e-3));
            whole += got.ee;
            expected_whole += want.ee;
        }
        CHECK(whole == doctest::Approx(expected_whole).epsilon(1e-6));
    }
}

// Whatever is done in whatever order: the mesh stays a triangulation of the same rectangle.
TEST_CASE("refine mesh: flips, splits and collapses keep the rectangle and the neighbours") {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        INFO("seed " << seed);
        const BaseMesh start = colored_grid(60, 40, 9, 7, seed);
        const double area = 59.0 * 39.0;
        RefineMesh mesh(start);
        check_sound(mesh, area);
        std::mt19937 random(seed);
        const auto positive = [&](Id a, Id b, Id c) {
            return signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]) > 0;
        };
        int flips = 0, collapses = 0, splits = 0;
        for (int step = 0; step < 400; ++step) {
            const Id f = static_cast<Id>(random() % mesh.faces.size());
            const std::size_t i = random() % 3;
            if (!mesh.live_face(f)) continue;
            const Face face = mesh.faces[f];
            const Id p = face[i], a = face[(i + 1) % 3], b = face[(i + 2) % 3];
            switch (random() % 4) {
                case 0: {
                    const Id g = mesh.across[f][i];
                    if (g == kNone) break;
                    Id q = kNone;
                    for (const Id v : mesh.faces[g])
                        if (v != a && v != b) q = v;
                    if (!positive(p, a, q) || !positive(q, b, p)) break;
                    mesh.flip(f, static_cast<int>(i));
                    CHECK(mesh.faces[f] == Face{p, a, q});
                    CHECK(mesh.faces[g] == Face{q, b, p});
                    ++flips;
                    break;
                }
                case 1: {
                    const Vec2f c = (mesh.position[p] + mesh.position[a] + mesh.position[b]) / 3;
                    const Vec2f at(snapped(c.x()), snapped(c.y()));
                    const auto fits = [&](Id u, Id v) {
                        return signed_area2(at, mesh.position[u], mesh.position[v]) > 0;
                    };
                    if (!fits(p, a) || !fits(a, b) || !fits(b, p)) break;
                    CHECK(mesh.fixed[mesh.split_face(f, at, Vec3f::Zero())] == RefineMesh::kFree);
                    ++splits;
                    break;
                }
                case 2: {
                    const Vec2f at = (mesh.position[a] + mesh.position[b]) / 2;
                    if (at != Vec2f(snapped(at.x()), snapped(at.y()))) break;
                    const bool border = mesh.across[f][i] == kNone;
                    const Id v = mesh.split_edge(f, static_cast<int>(i), at, Vec3f::Zero());
                    CHECK((mesh.fixed[v] != RefineMesh::kFree) == border);
                    ++splits;
                    break;
                }
                default: {
                    Star star;
                    if (!mesh.star(p, star) || !star.closed) break;
                    bool fine = true;
                    for (std::size_t k = 0; k < static_cast<std::size_t>(star.size); ++k) {
                        const Face& around = mesh.faces[star.face[k]];
                        const Id s = around[(star.corner[k] + 1u) % 3], t = around[(star.corner[k] + 2u) % 3];
                        if (s != a && t != a) fine = fine && positive(a, s, t);
                    }
                    if (!fine) break;
                    mesh.collapse(star, p, a);
                    CHECK_FALSE(mesh.live_vertex(p));
                    ++collapses;
                }
            }
            if (step % 40 == 0) check_sound(mesh, area);
        }
        check_sound(mesh, area);
        CHECK(flips > 10);
        CHECK(collapses > 10);
        CHECK(splits > 10);
    }
}

TEST_CASE("refine mesh: corners are fixed, vertices of the sides slide, others are free") {
    const RefineMesh mesh(colored_grid(60, 40, 5, 4, 7));
    for (Id v = 0; v < mesh.position.size(); ++v) {
        const bool x = mesh.position[v].x() == 0 || mesh.position[v].x() == 59;
        const bool y = mesh.position[v].y() == 0 || mesh.position[v].y() == 39;
        CHECK(mesh.fixed[v] == ((x ? RefineMesh::kFixedX : 0) | (y ? RefineMesh::kFixedY : 0)));
    }
}

// An L: the vertices of its inner corner and of the two sides there are not on a side of the bounding box.
TEST_CASE("refine mesh: a boundary inside the bounding box is fixed") {
    BaseMesh mesh = jittered_grid(0, 0, 40, 40, 4, 4, 3);
    for (int j = 0; j < 5; ++j)
        for (int i = 0; i < 5; ++i)
            mesh.position[static_cast<std::size_t>(j * 5 + i)] =
                Vec2f(static_cast<float>(10 * i), static_cast<float>(10 * j));
    std::erase_if(mesh.faces, [&](const Face& face) {
        const Vec2f c = mesh.position[face[0]] + mesh.position[face[1]] + mesh.position[face[2]];
        return c.x() > 60 && c.y() > 60;
    });
    const RefineMesh l(mesh);
    const auto fixed_at = [&](int i, int j) { return l.fixed[static_cast<std::size_t>(j * 5 + i)]; };
    CHECK(fixed_at(2, 2) == RefineMesh::kFixed);  // the inner corner
    CHECK(fixed_at(3, 2) == RefineMesh::kFixed);  // straight on, yet inside the box
    CHECK(fixed_at(2, 3) == RefineMesh::kFixed);
    CHECK(fixed_at(4, 2) == RefineMesh::kFixed);  // an end of the L
    CHECK(fixed_at(1, 4) == RefineMesh::kFixedY);
    CHECK(fixed_at(0, 1) == RefineMesh::kFixedX);
    CHECK(fixed_at(1, 1) == RefineMesh::kFree);
    CHECK_FALSE(l.live_vertex(4 * 5 + 4));
}
