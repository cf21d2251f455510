// What holds for every optimised mesh.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/optimize/optimize_mesh.h"
#include "libcore/pipeline/build.h"
#include "libcore/refine/refine.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/meshes.h"
#include "tests/support/refined_meshes.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

RefineParams rounds_of_exchanges(int rounds) {
    RefineParams params;
    params.rounds = rounds;
    params.exchange = 0.3;
    params.shape_weight = 0;
    return params;
}

}  // namespace

TEST_CASE(
    "optimised mesh: the error falls, is that of the drawing, and vertices and faces keep their number") {
    for (const Kind kind : kAllKinds)
        for (const auto& [w, h] : {std::pair{2, 2}, {3, 3}, {5, 7}, {60, 45}, {130, 20}})
            for (const bool keep_faces : {true, false}) {
                INFO(name_of(kind) << " " << w << " x " << h << " " << keep_faces);
                const FeatureImage feature = sample_feature(kind, w, h);
                BaseMesh mesh = collapsed(feature, std::max(4, w * h / 30));
                const std::size_t vertices = mesh.vertex_count(), faces = mesh.faces.size();
                RefineParams params = rounds_of_exchanges(3);
                params.keep_faces = keep_faces;
                params.anneal = keep_faces ? 0 : 20;
                const OptimizeReport report = optimize_mesh(mesh, feature, params);
                CHECK(report.after <= report.before);
                check_sound(mesh, vertices, w, h);
                if (keep_faces) CHECK(mesh.faces.size() == faces);
                // Its sums take samples in steps of 1/64.
                CHECK(report.after ==
                      doctest::Approx(drawn_error(mesh, feature)).epsilon(2e-3).scale(double(w * h)));
            }
}

TEST_CASE("optimised mesh: a lower error than that of refinement") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 90, 70);
    const BaseMesh start = collapsed(feature, 200);
    BaseMesh refined = start, optimized = start;
    refine(refined, feature, {.rounds = 8, .shape_weight = 0});
    optimize_mesh(optimized, feature, rounds_of_exchanges(8));
    CHECK(drawn_error(optimized, feature) < 0.95 * drawn_error(refined, feature));
}

TEST_CASE("optimised mesh: limits on shape and area hold, and shape weighs against error") {
    check_limits(rounds_of_exchanges(6),
                 [](BaseMesh& mesh, const FeatureImage& feature, const RefineParams& params) {
                     optimize_mesh(mesh, feature, params);
                 });
}

TEST_CASE("optimised mesh: the sides of a tile stay as they are") {
    for (const bool unit : {false, true}) {
        RefineParams params = rounds_of_exchanges(3);
        params.anneal = 20;
        params.keep_faces = false;
        params.range = unit ? ColorRange::kUnit : ColorRange::kLuv;
        check_sides(params, [](BaseMesh& mesh, const FeatureImage& feature, const RefineParams& kept) {
            optimize_mesh(mesh, feature, kept);
        });
    }
}

TEST_CASE("optimised mesh: positions are on the grid asked for, colours in the range asked for") {
    FeatureImage feature = sample_feature(Kind::kNoise, 120, 90);
    for (float& f : feature.data) f = std::abs(f) / 100;
    RefineParams params = rounds_of_exchanges(2);
    params.range = ColorRange::kUnit;
    params.position_step = 0.5f;
    // Its vertices are on pixels.
    BaseMesh mesh = jittered_grid(0, 0, 119, 89, 12, 9, 0);
    optimize_mesh(mesh, feature, params);
    for (const float f : mesh.feature) CHECK((f >= 0 && f <= 1));
    int halves = 0;
    for (const Vec2f& p : mesh.position)
        for (const float x : {p.x(), p.y()}) halves += x * 2 == std::round(x * 2);
    CHECK(halves > static_cast<int>(mesh.vertex_count()));
}

TEST_CASE("optimised mesh: the same bytes for any number of threads") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 120, 90);
    check_threads(collapsed(feature, 500),
                  [&](BaseMesh& mesh) { optimize_mesh(mesh, feature, rounds_of_exchanges(3)); });
}

TEST_CASE("optimised mesh: masked images keep boundary and topology") {
    BuildParams plain;
    plain.stop.density = 10;
    plain.refine = 0;
    BuildParams refined = plain;
    refined.refine = 3;
    refined.exchange = 0.3;
    refined.shape_weight = 0;
    check_masks(plain, refined);
}
