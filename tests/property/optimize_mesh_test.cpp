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

BaseMesh collapsed(const FeatureImage& feature, std::int64_t vertices, float min_shape = 0) {
    SimplifyParams params = plain_params();
    params.min_shape = min_shape;
    SimplifyTarget target;
    target.vertices = vertices;
    return simplify(grid_mesh(feature), params, target).mesh;
}

// From the rasteriser: pixel by pixel, and with nothing of the optimiser's sums.
double drawn_error(const BaseMesh& mesh, const FeatureImage& feature) {
    const double rms = map_rms(mesh, trivial_map(mesh, feature.width, feature.height), feature);
    return rms * rms * static_cast<double>(feature.pixel_count());
}

void check_sound(const BaseMesh& mesh, std::size_t vertices, int width, int height) {
    const MeshQuality q = mesh_quality(mesh);
    CHECK(mesh.vertex_count() == vertices);
    CHECK(q.euler == 1);
    CHECK(q.flipped_faces + q.nonmanifold_edges + q.nonmanifold_vertices == 0);
    CHECK(q.area == double(width - 1) * (height - 1));
    for (const Vec2f& p : mesh.position) CHECK(p == Vec2f(snapped(p.x()), snapped(p.y())));
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
    const FeatureImage feature = sample_feature(Kind::kDisc, 80, 60);
    const BaseMesh start = collapsed(feature, 150, 0.4f);
    RefineParams params = rounds_of_exchanges(6);
    const auto optimized = [&] {
        BaseMesh mesh = start;
        optimize_mesh(mesh, feature, params);
        return mesh;
    };
    const BaseMesh free = optimized();
    params.min_quality = 0.4;
    CHECK(mesh_quality(optimized()).min_shape >= 0.4);
    CHECK(mesh_quality(free).min_shape < 0.4);
    params.min_quality = 0;
    params.shape_weight = 1;
    CHECK(mesh_quality(optimized()).mean_shape > mesh_quality(free).mean_shape + 0.05);
    params.shape_weight = 0;
    const auto largest = [](const BaseMesh& mesh) {
        double area = 0;
        for (const auto& [a, b, c] : mesh.faces)
            area = std::max(area, signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]) / 2);
        return area;
    };
    params.max_face_area = largest(start);
    CHECK(largest(free) > params.max_face_area);
    CHECK(largest(optimized()) <= params.max_face_area);
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
    const BaseMesh start = collapsed(feature, 500);
    BaseMesh first = start, second = start;
    optimize_mesh(first, feature, rounds_of_exchanges(3));
    const ThreadLimit one(1);
    optimize_mesh(second, feature, rounds_of_exchanges(3));
    CHECK(first.position == second.position);
    CHECK(first.feature == second.feature);
    CHECK(first.faces == second.faces);
}

// Pixels outside the mask do not count, the boundary stays, and the map stays one to one.
TEST_CASE("optimised mesh: masked images keep boundary and topology") {
    for (const auto& [name, mask] : sample_masks(40)) {
        INFO(name);
        const Image image = sample_picture(Kind::kNoise, mask.width, mask.height);
        BuildParams params;
        params.stop.density = 10;
        params.refine = 0;
        const BuildResult plain = build_mesh_image(image, params, {}, mask);
        params.refine = 3;
        params.exchange = 0.3;
        params.shape_weight = 0;
        const BuildResult built = build_mesh_image(image, params, {}, mask);
        const Level& level = built.mesh_image.levels[0];
        const MeshQuality before = mesh_quality(plain.mesh_image.levels[0].mesh),
                          after = mesh_quality(level.mesh);
        CHECK(after.vertices == before.vertices);
        CHECK(after.euler == before.euler);
        CHECK(after.components == before.components);
        CHECK(after.area == before.area);
        CHECK(after.flipped_faces + after.nonmanifold_edges + after.nonmanifold_vertices == 0);
        const MapQuality map = map_quality(level.mesh, level.map, true);
        CHECK(map.unmapped + map.outside_simplex + map.flipped_triangles == 0);

        // The colours outside change nothing.
        Image other = image;
        for (std::size_t i = 0; i < image.pixel_count(); ++i)
            if (!mask.contains(i)) std::fill_n(&other.data[3 * i], 3, 1.0f);
        const BaseMesh again = build_mesh_image(other, params, {}, mask).mesh_image.levels[0].mesh;
        CHECK(again.position == level.mesh.position);
        CHECK(again.feature == level.mesh.feature);
    }
}
