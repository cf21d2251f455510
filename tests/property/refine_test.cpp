// What holds for every refinement.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build.h"
#include "libcore/refine/refine.h"
#include "libcore/refine/refiner.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/meshes.h"
#include "tests/support/refined_meshes.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// What is tested of the error alone.
RefineParams without_shape() {
    RefineParams params;
    params.shape_weight = 0;
    return params;
}

}  // namespace

// A step is taken only if it lowers the error, so this is a law; and the reported error is that of the
// drawing.
TEST_CASE("refine: the error never rises, and the mesh stays sound") {
    for (const Kind kind : kAllKinds)
        for (const auto& [w, h] :
             {std::pair{1, 1}, {1, 30}, {30, 1}, {2, 2}, {3, 3}, {5, 7}, {60, 45}, {130, 20}}) {
            INFO(name_of(kind) << " " << w << " x " << h);
            const FeatureImage feature = sample_feature(kind, w, h);
            BaseMesh mesh = collapsed(feature, std::max(4, w * h / 30));
            const std::size_t vertices = mesh.vertex_count(), faces = mesh.faces.size();
            RefineParams params = without_shape();
            params.rounds = 5;
            params.relocations = 0.1;
            const RefineReport report = refine(mesh, feature, params);
            for (std::size_t k = 1; k < report.error.size(); ++k)
                CHECK(report.error[k] < report.error[k - 1]);
            check_sound(mesh, vertices, w, h);
            CHECK(mesh.faces.size() == faces);
            CHECK(report.error.back() ==
                  doctest::Approx(drawn_error(mesh, feature)).epsilon(1e-4).scale(double(w * h)));
        }
}

TEST_CASE("refine: without rounds the colours alone are fitted") {
    const FeatureImage feature = sample_feature(Kind::kGradient, 60, 45);
    BaseMesh mesh = collapsed(feature, 60);
    const BaseMesh before = mesh;
    const RefineReport report = refine(mesh, feature, {.rounds = 0});
    CHECK(mesh.position == before.position);
    CHECK(mesh.faces == before.faces);
    CHECK(report.error.size() == 1);
    CHECK(report.error[0] < drawn_error(before, feature));
    CHECK(report.error[0] == doctest::Approx(drawn_error(mesh, feature)).epsilon(1e-4));
}

// A roof: two planes that meet in a ridge at x = 20. The middle column of the mesh is two pixels beside the
// ridge. It can be moved onto the ridge, and then no error is left.
TEST_CASE("refine: vertices find a ridge") {
    FeatureImage roof{41, 41, 3, {}};
    for (int y = 0; y < 41; ++y)
        for (int x = 0; x < 41; ++x) {
            const float height = 80 - 3 * std::abs(static_cast<float>(x) - 20);
            roof.data.insert(roof.data.end(), {height, 0, 0});
        }
    BaseMesh mesh;
    for (const float y : {0.0f, 20.0f, 40.0f})
        for (const float x : {0.0f, 22.0f, 40.0f}) {
            mesh.position.emplace_back(x, y);
            mesh.feature.insert(mesh.feature.end(), {50, 0, 0});
        }
    for (Id j = 0; j < 2; ++j)
        for (Id i = 0; i < 2; ++i) {
            const Id a = 3 * j + i, b = a + 1, c = a + 3, d = a + 4;
            mesh.faces.push_back({a, c, d});
            mesh.faces.push_back({a, d, b});
        }
    RefineParams params = without_shape();
    params.rounds = 20;
    params.relocations = 0;
    const RefineReport report = refine(mesh, roof, params);
    CHECK(report.error.front() / (41 * 41) > 1);
    CHECK(report.error.back() / (41 * 41) < 1e-3);
    for (const std::size_t v : {1u, 4u, 7u})
        CHECK(mesh.position[v].x() == doctest::Approx(20).epsilon(0.005));
}

// A diagonal edge between two flat colours, and a mesh of two triangles whose diagonal is the other one.
TEST_CASE("refine: edges flip along the image's edges") {
    FeatureImage halves{33, 33, 3, {}};
    for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 33; ++x) {
            const float fold = static_cast<float>(std::abs(x - y));
            halves.data.insert(halves.data.end(), {20 + fold, 0, 0});
        }
    BaseMesh mesh;
    mesh.position = {{0, 0}, {32, 0}, {0, 32}, {32, 32}};
    mesh.feature.assign(12, 30.0f);
    mesh.faces = {{0, 2, 1}, {1, 2, 3}};
    RefineParams params = without_shape();
    params.rounds = 2;
    const RefineReport report = refine(mesh, halves, params);
    CHECK(report.flips == 1);
    CHECK(report.error.back() < 1e-5 * report.error.front());
}

// Noise in one corner, nothing elsewhere, and vertices spread evenly: they move to where they are needed.
TEST_CASE("refine: vertices are relocated to where the error is") {
    FeatureImage feature = sample_feature(Kind::kConstant, 64, 64);
    const FeatureImage detail = sample_feature(Kind::kDisc, 20, 20);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x)
            std::copy_n(detail.pixel(x, y), 3, feature.pixel(static_cast<std::size_t>(y * 64 + x)));
    BaseMesh mesh = jittered_grid(0, 0, 63, 63, 8, 8, 5);
    const auto inside = [&] {
        int n = 0;
        for (const Vec2f& p : mesh.position) n += p.x() < 21 && p.y() < 21;
        return n;
    };
    const int before = inside();
    RefineParams params = without_shape();
    params.rounds = 10;
    params.relocations = 0.1;
    const RefineReport report = refine(mesh, feature, params);
    CHECK(report.relocations > 10);
    CHECK(inside() >= before + 10);
    CHECK(report.error.back() < 0.2 * report.error.front());
    check_sound(mesh, 81, 64, 64);
}

TEST_CASE("refine: limits on shape and area hold, and shape weighs against error") {
    RefineParams params = without_shape();
    params.rounds = 6;
    params.relocations = 0.1;
    check_limits(params, [](BaseMesh& mesh, const FeatureImage& feature, const RefineParams& limited) {
        refine(mesh, feature, limited);
    });
}

TEST_CASE("refine: the sides of a tile stay as they are") {
    RefineParams params;
    params.rounds = 4;
    params.relocations = 0.1;
    check_sides(params, [](BaseMesh& mesh, const FeatureImage& feature, const RefineParams& kept) {
        refine(mesh, feature, kept);
    });
}

TEST_CASE("refine: the same bytes for any number of threads, in the range of colours asked for") {
    FeatureImage feature = sample_feature(Kind::kNoise, 120, 90);
    for (float& f : feature.data) f = std::abs(f) / 100;
    RefineParams params = without_shape();
    params.rounds = 4;
    params.range = ColorRange::kUnit;
    const BaseMesh refined =
        check_threads(collapsed(feature, 500), [&](BaseMesh& mesh) { refine(mesh, feature, params); });
    for (const float f : refined.feature) CHECK((f >= 0 && f <= 1));
}

// Every step keeps the sums of each face up to date, so that their error is that of the drawing.
TEST_CASE("refine: each step's error is that of the drawing") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 90, 70);
    RefineParams params = without_shape();
    params.shape_weight = 0.2;
    const ImagePlanes planes(feature);
    Refiner refiner(collapsed(feature, 300), planes, params);
    const auto check = [&](const char* after) {
        INFO(std::string(after));
        CHECK(refiner.total_error() == doctest::Approx(drawn_error(refiner.result(), feature)).epsilon(1e-5));
    };
    check("the start");
    REQUIRE(refiner.flip_and_relocate().relocations > 0);
    check("relocations");
    REQUIRE(refiner.move_vertices() > 0);
    check("moves");
    REQUIRE(refiner.flip_edges() > 0);
    check("flips");
    refiner.fit_colors();
    check("new colours");
}

TEST_CASE("refine: masked images keep boundary and topology") {
    BuildParams plain;
    plain.stop.density = 10;
    BuildParams refined = plain;
    refined.refine = 3;
    check_masks(plain, refined);
}
