// What must hold for the base mesh of any image.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/metrics/metrics.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"
#include "tests/support/sound_mesh.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

SimplifyResult collapse(const FeatureImage& feature, const SimplifyTarget& target,
                        const SimplifyParams& params = plain_params()) {
    return simplify(grid_mesh(feature), params, target);
}

SimplifyTarget to_vertices(std::int64_t vertices) {
    return {.vertices = vertices};
}

bool same(const BaseMesh& a, const BaseMesh& b) {
    return a.position == b.position && a.feature == b.feature && a.faces == b.faces;
}

constexpr Size kSizes[] = {{2, 2}, {3, 3}, {1, 1}, {1, 9}, {9, 1}, {2, 12}, {5, 7}, {16, 16}, {40, 30}};

}  // namespace

TEST_CASE("collapse: the base mesh triangulates the image's rectangle, down to the least") {
    for (const Size size : kSizes)
        for (const Kind kind : kAllKinds) {
            const FeatureImage feature = sample_feature(kind, size.width, size.height);
            const auto pixels = static_cast<std::int64_t>(feature.pixel_count());
            for (const std::int64_t target :
                 {pixels, pixels / 2, pixels / 10, pixels / 40, std::int64_t{4}}) {
                INFO(name_of(kind) << " " << size.width << " x " << size.height << " to " << target);
                const SimplifyResult result = collapse(feature, to_vertices(target));
                check_sound(result.mesh, size);
                const auto vertices = static_cast<std::int64_t>(result.mesh.vertex_count());
                const auto dense =
                    static_cast<std::int64_t>(std::max(2, size.width)) * std::max(2, size.height);
                CHECK(vertices + result.collapses == dense);
                CHECK(vertices >= std::min(dense, target));
            }
        }
}

TEST_CASE("collapse: the target is met") {
    for (const Size size : {Size{5, 7}, Size{16, 16}, Size{40, 30}})
        for (const Kind kind : kAllKinds) {
            INFO(name_of(kind) << " " << size.width << " x " << size.height);
            const FeatureImage feature = sample_feature(kind, size.width, size.height);
            const auto pixels = static_cast<std::int64_t>(feature.pixel_count());
            for (const std::int64_t target : {pixels / 2, pixels / 4, std::max<std::int64_t>(8, pixels / 40)})
                CHECK(collapse(feature, to_vertices(target)).mesh.vertex_count() ==
                      static_cast<std::size_t>(target));
            // One collapse removes two faces, or one at the border.
            for (const std::int64_t target : {pixels, pixels / 2, std::max<std::int64_t>(8, pixels / 20)}) {
                const auto faces =
                    static_cast<std::int64_t>(collapse(feature, {.faces = target}).mesh.faces.size());
                CHECK(faces <= target);
                CHECK(faces >= target - 1);
            }
        }
}

TEST_CASE("collapse: where nothing but the guards stops it, two triangles remain of a constant image") {
    const BaseMesh mesh = collapse(sample_feature(Kind::kConstant, 16, 12), to_vertices(0)).mesh;
    CHECK(mesh.vertex_count() == 4);
    CHECK(mesh.faces.size() == 2);
}

TEST_CASE("collapse: the first of several limits counts") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 16, 16);
    CHECK(collapse(feature, {.vertices = 50, .faces = 10}).mesh.vertex_count() == 50);
    const std::size_t faces = collapse(feature, {.vertices = 5, .faces = 60}).mesh.faces.size();
    CHECK((faces == 60 || faces == 59));
}

TEST_CASE("collapse: no vertex costs more than the largest error allowed") {
    for (const Kind kind : kAllKinds) {
        INFO(name_of(kind));
        const FeatureImage feature = sample_feature(kind, 20, 15);
        std::size_t vertices_before = 20 * 15 + 1;
        for (const double limit : {0.0, 10.0, 1e3, 1e5}) {
            const SimplifyResult result = collapse(feature, {.max_error = limit});
            CHECK(result.error <= limit);
            check_sound(result.mesh, {20, 15});
            CHECK(result.mesh.vertex_count() <= vertices_before);
            vertices_before = result.mesh.vertex_count();
        }
        // Every vertex has a distance to the centroids around it, so no collapse is free.
        CHECK(collapse(feature, {.max_error = 0}).collapses == 0);
        // And without a limit the error is large.
        CHECK(collapse(feature, to_vertices(20)).error > 10);
    }
}

// One limit for many pictures gives all the same error; a run that passes several of them counts vertices for
// each. Large enough for tiles.
TEST_CASE("collapse: a limit on what a merge adds, alone and as one of several of a run") {
    for (const Kind kind : {Kind::kNoise, Kind::kDisc, Kind::kGradient}) {
        const GridMesh grid = grid_mesh(sample_feature(kind, 230, 170));
        const double last = simplify(grid, plain_params(), to_vertices(1500)).increment;
        const SimplifyTarget targets[] = {
            {.max_increment = 0.5 * last}, {.max_increment = 0.8 * last}, {.max_increment = last}};
        const std::vector<SimplifyResult> run = simplify(grid, plain_params(), targets);
        std::size_t before = grid.vertex_count();
        for (std::size_t k = 0; k < run.size(); ++k) {
            INFO(name_of(kind) << " " << k);
            const SimplifyResult alone = simplify(grid, plain_params(), targets[k]);
            for (const SimplifyResult& result : {run[k], alone}) {
                check_sound(result.mesh, {230, 170});
                CHECK(result.increment <= targets[k].max_increment * (1 + 1e-6));
            }
            // Flat parts tie, and then the order decides more.
            const double within = kind == Kind::kDisc ? 0.03 : 0.005;
            const auto vertices = static_cast<double>(alone.mesh.vertex_count());
            CHECK(std::abs(static_cast<double>(run[k].mesh.vertex_count()) - vertices) <=
                  within * vertices + 4);
            CHECK(run[k].mesh.vertex_count() < before);
            before = run[k].mesh.vertex_count();
        }
        // The last limit is the one that leaves about so many.
        CHECK(before > 1200);
        CHECK(before <= 1600);
        const SimplifyTarget either{.vertices = 3000, .max_increment = last};
        CHECK(simplify(grid, plain_params(), either).mesh.vertex_count() == 3000);
    }
}

// Large enough for several tiles in each direction, one after the other, and for the whole image after them.
TEST_CASE("collapse: tiles make a sound mesh, the same every time, with any number of threads") {
    for (const Kind kind : {Kind::kNoise, Kind::kCheckerboard, Kind::kDisc}) {
        constexpr Size kLarge{230, 170};
        const FeatureImage feature = sample_feature(kind, kLarge.width, kLarge.height);
        for (const std::int64_t target : {12000, 400}) {
            INFO(name_of(kind) << " to " << target);
            const BaseMesh first = collapse(feature, to_vertices(target)).mesh;
            check_sound(first, kLarge);
            CHECK(first.vertex_count() == static_cast<std::size_t>(target));
            for (const int threads : {1, 2, 3}) {
                const ThreadLimit limit(threads);
                CHECK(same(collapse(feature, to_vertices(target)).mesh, first));
            }
        }
    }
}

// A limit reached in the middle of the tiles would leave some of them fine and others coarse.
TEST_CASE("collapse: no part of an even image is favoured") {
    for (const Kind kind : {Kind::kConstant, Kind::kNoise})
        for (const std::int64_t target : {9000, 1000, 200}) {
            INFO(name_of(kind) << " to " << target);
            const BaseMesh mesh = collapse(sample_feature(kind, 230, 170), to_vertices(target)).mesh;
            std::int64_t quadrant[4] = {};
            for (const Vec2f& p : mesh.position)
                ++quadrant[(p.x() > 114.5f ? 1 : 0) + (p.y() > 84.5f ? 2 : 0)];
            for (const std::int64_t count : quadrant) {
                CHECK(count > target / 6);
                CHECK(count < target / 3);
            }
        }
}

// All planes agree, so every merge keeps the colour on that plane, at any position.
TEST_CASE("collapse: a linear image keeps its colours at every vertex") {
    FeatureImage feature{24, 18, 3, {}};
    const auto color = [](float x, float y) { return Vec3f(20 + 2 * x + y, 3 * y - x, 5 - x); };
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 24; ++x) {
            const Vec3f c = color(static_cast<float>(x), static_cast<float>(y));
            feature.data.insert(feature.data.end(), c.data(), c.data() + 3);
        }
    // Without smoothing, because its repeated borders would bend the gradients there.
    const BaseMesh mesh = collapse(feature, to_vertices(30), {.smoothing = 0}).mesh;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f expected = color(mesh.position[v].x(), mesh.position[v].y());
        CHECK((Eigen::Map<const Vec3f>(mesh.feature_of(v)) - expected).norm() < 1e-3);
    }
}

// A large lambda asks for even spacing, so shape improves where the image is uniform.
TEST_CASE("collapse: more geometry weight makes rounder triangles") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 40, 30);
    const auto roundness = [&](float geometry_weight) {
        const SimplifyResult result =
            collapse(feature, to_vertices(120), {.geometry_weight = geometry_weight});
        return mesh_quality(result.mesh).mean_radius_ratio;
    };
    CHECK(roundness(1e5f) > roundness(0.1f) + 0.02);
}

TEST_CASE("collapse: progress never falls and stays within 0 and 1") {
    double last = 0;
    int calls = 0;
    simplify(grid_mesh(sample_feature(Kind::kGradient, 300, 260)), plain_params(), to_vertices(500),
             [&](double f, std::string_view) {
                 CHECK(f >= last);
                 CHECK(f <= 1);
                 last = f;
                 ++calls;
             });
    CHECK(calls > 0);
}

// The coarser level continues from the finer one; the finer one must not depend on later levels.
TEST_CASE("collapse: levels of one run are what single runs give, each coarser than the one before") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 40, 30);
    const SimplifyTarget targets[] = {{.vertices = 300}, {.vertices = 120}, {.faces = 60}};
    const auto levels = simplify(grid_mesh(feature), plain_params(), targets);
    REQUIRE(levels.size() == 3);
    CHECK(levels[0].mesh.position == collapse(feature, targets[0]).mesh.position);
    CHECK(levels[0].mesh.faces == collapse(feature, targets[0]).mesh.faces);
    CHECK(levels[1].mesh.vertex_count() == 120);
    CHECK(levels[2].mesh.faces.size() <= 60);
    CHECK(levels[2].error >= levels[1].error);
    for (const SimplifyResult& level : levels) check_sound(level.mesh, {40, 30});
}

TEST_CASE("collapse: no face is larger or thinner than the limits allow") {
    for (const Kind kind : {Kind::kConstant, Kind::kNoise, Kind::kDisc}) {
        INFO(name_of(kind));
        const SimplifyResult result =
            collapse(sample_feature(kind, 40, 30), to_vertices(0), {.max_face_area = 9, .min_shape = 0.5f});
        check_sound(result.mesh, {40, 30});
        CHECK(result.collapses > 0);
        CHECK(mesh_quality(result.mesh).min_shape >= 0.4999);
        for (const auto& [a, b, c] : result.mesh.faces)
            CHECK(signed_area2(result.mesh.position[a], result.mesh.position[b], result.mesh.position[c]) <=
                  18);
    }
}

TEST_CASE("collapse: rebuilt quadrics and total priority give sound meshes of their own") {
    for (const Kind kind : {Kind::kNoise, Kind::kDisc}) {
        INFO(name_of(kind));
        const FeatureImage feature = sample_feature(kind, 40, 30);
        const SimplifyTarget target = to_vertices(100);
        const BaseMesh plain = collapse(feature, target).mesh;
        for (const SimplifyParams& params : {plain_params_but([](auto& p) { p.rebuild_quadrics = true; }),
                                             plain_params_but([](auto& p) { p.total_priority = true; })}) {
            const BaseMesh mesh = collapse(feature, target, params).mesh;
            check_sound(mesh, {40, 30});
            CHECK(mesh.vertex_count() == 100);
            CHECK(mesh.position != plain.position);
        }
    }
}

// On the dense mesh both agree: the mesh is the image.
TEST_CASE("quadrics of the current mesh are those of the dense one before anything has collapsed") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 9, 7));
    const auto dense = vertex_quadrics<3>(grid, FeaturePatch{grid.feature}, 2.5f);
    const auto current = current_quadrics(ring_mesh(grid), dense, 2.5f);
    for (std::size_t v = 0; v < dense.size(); ++v) {
        const float x = static_cast<float>(v % 9) + 0.3f, y = static_cast<float>(v / 9) - 0.4f;
        const float color[3] = {50, 10, -20};
        CHECK(current[v].at(x, y, color) == doctest::Approx(dense[v].at(x, y, color)).epsilon(1e-4));
    }
}
