// What must hold for the base mesh by every metric and solver.
#include <doctest/doctest.h>

#include <tuple>

#include "libcore/base/parallel.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"
#include "tests/support/sound_mesh.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr Metric kMetrics[] = {Metric::kFlattened, Metric::kHoppe, Metric::kGarland};
constexpr Size kSizes[] = {{1, 1}, {2, 2}, {3, 3}, {1, 9}, {9, 1}, {5, 7}, {32, 24}};

SimplifyResult collapse(const FeatureImage& feature, std::int64_t vertices, const SimplifyParams& params) {
    return simplify(grid_mesh(feature), params, SimplifyTarget{.vertices = vertices});
}

}  // namespace

TEST_CASE("metrics: every one makes a sound mesh of every image, by every solver") {
    for (const auto& [metric, solver] : {std::pair(Metric::kFlattened, Solver::kSvd),
                                         {Metric::kFlattened, Solver::kLu},
                                         {Metric::kHoppe, Solver::kClosed},
                                         {Metric::kHoppe, Solver::kSvd},
                                         {Metric::kHoppe, Solver::kLu},
                                         {Metric::kGarland, Solver::kClosed},
                                         {Metric::kGarland, Solver::kLu}})
        for (const Size size : kSizes)
            for (const Kind kind : kAllKinds) {
                const FeatureImage feature = sample_feature(kind, size.width, size.height);
                for (const std::int64_t vertices : {size.width * size.height / 10, 4}) {
                    INFO(metric_name(metric) << ", " << solver_name(solver) << ", " << name_of(kind) << " "
                                             << size.width << " x " << size.height << " to " << vertices);
                    const SimplifyResult result = collapse(feature, vertices, plain_params(metric, solver));
                    check_sound(result.mesh, size);
                    if (vertices > 8) CHECK(result.mesh.vertex_count() == std::size_t(vertices));
                }
            }
}

TEST_CASE("metrics: with rebuilt quadrics and total priority as well, each a mesh of its own") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 32, 24);
    for (const Metric metric : {Metric::kHoppe, Metric::kGarland}) {
        INFO(metric_name(metric));
        const BaseMesh plain = collapse(feature, 80, plain_params(metric)).mesh;
        CHECK(plain.position != collapse(feature, 80, plain_params()).mesh.position);
        for (const SimplifyParams& params :
             {plain_params_but([](auto& p) { p.rebuild_quadrics = true; }, metric),
              plain_params_but([](auto& p) { p.total_priority = true; }, metric)}) {
            const BaseMesh mesh = collapse(feature, 80, params).mesh;
            check_sound(mesh, {32, 24});
            CHECK(mesh.vertex_count() == 80);
            CHECK(mesh.position != plain.position);
        }
    }
}

// One function, two forms and three solvers differ by rounding and thus in ties. The disc has flat parts,
// whose edges all tie, so the meshes need not be equal; their errors must be.
TEST_CASE("metrics: solvers and forms differ by rounding alone") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 32, 24);
    for (const Metric metric : kMetrics) {
        INFO(metric_name(metric));
        const SimplifyResult closed =
            collapse(feature, 60, plain_params_but([](auto& p) { p.tiles = false; }, metric));
        for (const Solver solver : {Solver::kSvd, Solver::kLu}) {
            const SimplifyResult other = collapse(
                feature, 60,
                plain_params_but([&, by = solver](auto& p) { p.tiles = false, p.solver = by; }, metric));
            CHECK(other.mesh.vertex_count() == closed.mesh.vertex_count());
            CHECK(other.error == doctest::Approx(closed.error).epsilon(0.1));
        }
    }
}

// Hoppe's metric measures only colour, so a linear image costs nothing however far it is reduced, and keeps
// its colours. The paper's metric also counts how far vertices move.
TEST_CASE("metrics: a linear image is free of error to all but the flattened metric") {
    FeatureImage feature{20, 16, 3, {}};
    const auto color = [](float x, float y) { return Vec3f(20 + 2 * x + y, 3 * y - x, 5 - x); };
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 20; ++x) {
            const Vec3f c = color(static_cast<float>(x), static_cast<float>(y));
            feature.data.insert(feature.data.end(), c.data(), c.data() + 3);
        }
    for (const Metric metric : kMetrics) {
        INFO(metric_name(metric));
        const SimplifyResult result =
            collapse(feature, 12, plain_params_but([](auto& p) { p.smoothing = 0; }, metric));
        check_sound(result.mesh, {20, 16});
        if (metric == Metric::kFlattened)
            CHECK(result.error > 1);
        else
            CHECK(result.error < 1e-6);
        for (Id v = 0; v < result.mesh.vertex_count(); ++v) {
            const Vec2f& p = result.mesh.position[v];
            CHECK((Eigen::Map<const Vec3f>(result.mesh.feature_of(v)) - color(p.x(), p.y())).norm() < 1e-3f);
        }
    }
}

// The flat half's edges cost nothing at all. The windows of the queue start at the smallest possible cost,
// and must still reach the noisy half's costs soon.
TEST_CASE("metrics: hoppe's on an image that is flat in one half") {
    FeatureImage feature = sample_feature(Kind::kNoise, 120, 80);
    for (int y = 0; y < 80; ++y)
        for (int x = 0; x < 70; ++x)
            std::fill_n(feature.pixel(static_cast<std::size_t>(y * 120 + x)), 3, 40.0f);
    for (const std::int64_t vertices : {3000, 200}) {
        const BaseMesh mesh = collapse(feature, vertices, {.metric = Metric::kHoppe, .smoothing = 0}).mesh;
        check_sound(mesh, {120, 80});
        CHECK(mesh.vertex_count() == std::size_t(vertices));
        const auto flat = std::count_if(mesh.position.begin(), mesh.position.end(),
                                        [](const Vec2f& p) { return p.x() < 68; });
        CHECK(flat < vertices / 8);
    }
}

TEST_CASE("metrics: the same mesh with any number of threads") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 150, 90);
    for (const Metric metric : {Metric::kHoppe, Metric::kGarland}) {
        const BaseMesh first = collapse(feature, 300, {.metric = metric, .rebuild_quadrics = true}).mesh;
        for (const int threads : {1, 3}) {
            const ThreadLimit limit(threads);
            const BaseMesh mesh = collapse(feature, 300, {.metric = metric, .rebuild_quadrics = true}).mesh;
            CHECK(mesh.position == first.position);
            CHECK(mesh.feature == first.feature);
            CHECK(mesh.faces == first.faces);
        }
    }
}

TEST_CASE("metrics: masked images keep their topology") {
    for (const NamedMask& named : sample_masks(32))
        for (const Metric metric : {Metric::kHoppe, Metric::kGarland}) {
            INFO(named.name << ", " << metric_name(metric));
            const GridMesh grid =
                grid_mesh(sample_feature(Kind::kDisc, named.mask.width, named.mask.height), named.mask);
            const MeshQuality dense =
                mesh_quality(simplify(grid, plain_params(metric), {.vertices = 1 << 20}).mesh);
            const MeshQuality coarse =
                mesh_quality(simplify(grid, plain_params(metric), {.vertices = 0}).mesh);
            CHECK(coarse.components == dense.components);
            CHECK(coarse.euler == dense.euler);
            CHECK(coarse.flipped_faces == 0);
            CHECK(coarse.nonmanifold_edges == 0);
        }
}

// A number of features that is padded.
TEST_CASE("metrics: any number of features") {
    FeatureImage five{20, 16, 5, {}};
    const FeatureImage color = sample_feature(Kind::kNoise, 20, 16);
    for (std::size_t v = 0; v < color.pixel_count(); ++v) {
        five.data.insert(five.data.end(), color.pixel(v), color.pixel(v) + 3);
        five.data.insert(five.data.end(), {color.pixel(v)[0], 7.0f});
    }
    for (const Metric metric : kMetrics) {
        const BaseMesh mesh = collapse(five, 30, plain_params(metric, Solver::kSvd)).mesh;
        CHECK(mesh.channels == 5);
        CHECK(mesh.feature.size() == 5 * mesh.vertex_count());
        for (Id v = 0; v < mesh.vertex_count(); ++v) {
            CHECK(double(mesh.feature_of(v)[3]) ==
                  doctest::Approx(double(mesh.feature_of(v)[0])).epsilon(1e-3));
            CHECK(double(mesh.feature_of(v)[4]) == doctest::Approx(7.0));
        }
    }
}
