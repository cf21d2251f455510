// What must hold for the base mesh of any picture.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/metrics/metrics.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

struct Size {
    int width, height;
};

CollapseResult collapse(const FeatureImage& feature, const CollapseParams& params) {
    return collapse_edges(grid_mesh(feature), params);
}

CollapseParams to_vertices(std::int64_t vertices) {
    CollapseParams params;
    params.target_vertices = vertices;
    return params;
}

bool has_vertex(const BaseMesh& mesh, float x, float y) {
    return std::any_of(mesh.position.begin(), mesh.position.end(),
                       [&](const Vec2f& p) { return p.x() == x && p.y() == y; });
}

// A triangulation of the picture's rectangle on the position grid. (Areas on that grid are exact.)
void check_sound(const BaseMesh& mesh, Size size) {
    const MeshQuality q = mesh_quality(mesh);
    CHECK(q.nonmanifold_edges == 0);
    CHECK(q.nonmanifold_vertices == 0);
    CHECK(q.components == 1);
    CHECK(q.euler == 1);
    CHECK(q.flipped_faces == 0);
    const float left = size.width == 1 ? -0.5f : 0,
                right = size.width == 1 ? 0.5f : static_cast<float>(size.width - 1);
    const float top = size.height == 1 ? -0.5f : 0,
                bottom = size.height == 1 ? 0.5f : static_cast<float>(size.height - 1);
    CHECK(q.area == double(right - left) * double(bottom - top));
    for (const float x : {left, right})
        for (const float y : {top, bottom}) CHECK(has_vertex(mesh, x, y));
    for (const Vec2f& p : mesh.position) {
        CHECK(std::remainder(p.x(), kPositionStep) == 0);
        CHECK(std::remainder(p.y(), kPositionStep) == 0);
    }
    CHECK(mesh.feature.size() == 3 * mesh.vertex_count());
    CHECK(std::all_of(mesh.feature.begin(), mesh.feature.end(), [](float f) { return std::isfinite(f); }));
}

bool same(const BaseMesh& a, const BaseMesh& b) {
    return a.position == b.position && a.feature == b.feature && a.faces == b.faces;
}

constexpr Size kSizes[] = {{2, 2}, {3, 3}, {1, 1}, {1, 9}, {9, 1}, {2, 12}, {5, 7}, {16, 16}, {40, 30}};

}  // namespace

TEST_CASE("collapse: the base mesh triangulates the picture's rectangle, down to the least") {
    for (const Size size : kSizes)
        for (const Kind kind : kAllKinds) {
            const FeatureImage feature = sample_feature(kind, size.width, size.height);
            const auto pixels = static_cast<std::int64_t>(feature.pixel_count());
            for (const std::int64_t target :
                 {pixels, pixels / 2, pixels / 10, pixels / 40, std::int64_t{4}}) {
                INFO(name_of(kind) << " " << size.width << " x " << size.height << " to " << target);
                const CollapseResult result = collapse(feature, to_vertices(target));
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
            // One collapse takes two faces, or one at the border.
            CollapseParams params;
            for (const std::int64_t target : {pixels, pixels / 2, std::max<std::int64_t>(8, pixels / 20)}) {
                params.target_faces = target;
                const auto faces = static_cast<std::int64_t>(collapse(feature, params).mesh.faces.size());
                CHECK(faces <= target);
                CHECK(faces >= target - 1);
            }
        }
}

TEST_CASE("collapse: where nothing but the guards stops it, two triangles remain of a constant picture") {
    const BaseMesh mesh = collapse(sample_feature(Kind::kConstant, 16, 12), to_vertices(0)).mesh;
    CHECK(mesh.vertex_count() == 4);
    CHECK(mesh.faces.size() == 2);
}

TEST_CASE("collapse: the first of several limits counts") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 16, 16);
    CollapseParams params = to_vertices(50);
    params.target_faces = 10;
    CHECK(collapse(feature, params).mesh.vertex_count() == 50);
    params = to_vertices(5);
    params.target_faces = 60;
    const std::size_t faces = collapse(feature, params).mesh.faces.size();
    CHECK((faces == 60 || faces == 59));
}

TEST_CASE("collapse: no vertex costs more than the largest error allowed") {
    for (const Kind kind : kAllKinds) {
        INFO(name_of(kind));
        const FeatureImage feature = sample_feature(kind, 20, 15);
        std::size_t vertices_before = 20 * 15 + 1;
        for (const double limit : {0.0, 10.0, 1e3, 1e5}) {
            CollapseParams params;
            params.max_error = limit;
            const CollapseResult result = collapse(feature, params);
            CHECK(result.error <= limit);
            check_sound(result.mesh, {20, 15});
            CHECK(result.mesh.vertex_count() <= vertices_before);
            vertices_before = result.mesh.vertex_count();
        }
        // Every vertex has a distance to the centroids around it, so nothing is free.
        CollapseParams none;
        none.max_error = 0;
        CHECK(collapse(feature, none).collapses == 0);
        // And without a limit much is paid.
        CHECK(collapse(feature, to_vertices(20)).error > 10);
    }
}

// Large enough for several tiles each way, which are collapsed side by side, and for what is left after them.
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

// All planes agree, so every merge keeps the colour on the one plane, wherever it puts the vertex.
TEST_CASE("collapse: a linear picture keeps its colours at every vertex") {
    FeatureImage feature{24, 18, 3, {}};
    const auto color = [](float x, float y) { return Vec3f(20 + 2 * x + y, 3 * y - x, 5 - x); };
    for (int y = 0; y < 18; ++y)
        for (int x = 0; x < 24; ++x) {
            const Vec3f c = color(static_cast<float>(x), static_cast<float>(y));
            feature.data.insert(feature.data.end(), c.data(), c.data() + 3);
        }
    CollapseParams params = to_vertices(30);
    params.smoothing = 0;  // borders repeated would bend the gradients there
    const BaseMesh mesh = collapse(feature, params).mesh;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f expected = color(mesh.position[v].x(), mesh.position[v].y());
        CHECK((Eigen::Map<const Vec3f>(mesh.feature_of(v)) - expected).norm() < 1e-3);
    }
}

// A large lambda asks for even spacing, so shape improves where the picture has nothing to say for it.
TEST_CASE("collapse: more geometry weight makes rounder triangles") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 40, 30);
    CollapseParams flat = to_vertices(120), round = flat;
    flat.geometry_weight = 0.1f;
    round.geometry_weight = 1e5f;
    CHECK(mesh_quality(collapse(feature, round).mesh).mean_radius_ratio >
          mesh_quality(collapse(feature, flat).mesh).mean_radius_ratio + 0.02);
}

TEST_CASE("collapse: progress never falls and stays within 0 and 1") {
    double last = 0;
    int calls = 0;
    collapse_edges(grid_mesh(sample_feature(Kind::kGradient, 300, 260)), to_vertices(500),
                   [&](double f, std::string_view) {
                       CHECK(f >= last);
                       CHECK(f <= 1);
                       last = f;
                       ++calls;
                   });
    CHECK(calls > 0);
}
