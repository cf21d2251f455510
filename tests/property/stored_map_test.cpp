// What must hold for the weights that a container holds of a map on a grid, of any image.
#include <doctest/doctest.h>

#include "libcore/base/error.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/relax.h"
#include "libcore/param/stored_map.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/meshes.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

struct Scene {
    BaseMesh mesh;
    Displacements places;
};

Scene relaxed(Kind kind, int steps, float rate) {
    const FeatureImage feature = sample_feature(kind, 48, 36);
    BaseMesh mesh = simplify(grid_mesh(feature), plain_params(), SimplifyTarget{.vertices = 30}).mesh;
    const std::vector<FaceField> fields = face_fields(mesh);
    PixelEmbedding pixels = resting_pixels(trivial_map(mesh, 48, 36));
    relax(pixels, mesh, fields, face_neighbors(mesh), feature,
          {.smoothness = 5, .steps = steps, .rate = rate, .sweeps = 12});
    return {std::move(mesh), displacements(pixels, steps)};
}

// Two faces over an image of 3 x 3 pixels, `side` times as large, whose pixels crowd in its middle, a step of
// 1/8 pixel apart.
Scene crowded(int side) {
    const float end = static_cast<float>(side);
    BaseMesh mesh{
        3, {{0, 0}, {end, 0}, {end, end}, {0, end}}, std::vector<float>(12, 0), {{0, 2, 1}, {0, 3, 2}}};
    Displacements places{{3, 3}, 8, {}, {}, {}};
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 3; ++x) {
            places.dx.push_back(static_cast<std::int16_t>(side * 4 + 9 - 7 * x));
            places.dy.push_back(static_cast<std::int16_t>(side * 2 + 2 - 7 * y));
        }
    return {std::move(mesh), std::move(places)};
}

}  // namespace

TEST_CASE("stored map: no triangle of any relaxed map folds, on any grid, and displacements come back") {
    for (const Kind kind : kAllKinds)
        for (const int steps : {8, 16, 32})
            for (const float rate : {0.0f, 2.0f}) {
                INFO(name_of(kind) << ", " << steps << " steps, rate " << rate);
                const Scene s = relaxed(kind, steps, rate);
                for (const std::optional<WeightPrecision> wanted :
                     {std::optional<WeightPrecision>(), std::optional(WeightPrecision::kFloat)}) {
                    const PixelMap map = stored_map(s.mesh, s.places, wanted);
                    if (wanted) CHECK(map.precision == *wanted);
                    const MapQuality q = map_quality(s.mesh, map);
                    CHECK(q.unmapped == 0);
                    CHECK(q.outside_simplex == 0);
                    CHECK(q.flipped_triangles == 0);
                    CHECK(q.min_area2 >= kLeastStoredArea);
                    const std::optional<Displacements> back = displacements_of(s.mesh, map);
                    REQUIRE(back.has_value());
                    CHECK(locate_map(s.mesh, *back, map.precision).map == map);
                }
            }
}

TEST_CASE("stored map: floats where half weights would fold, and an error where these are wanted") {
    const Scene small = crowded(16), large = crowded(1000);
    CHECK(stored_map(small.mesh, small.places, {}).precision == WeightPrecision::kHalf);
    CHECK(stored_map(large.mesh, large.places, {}).precision == WeightPrecision::kFloat);
    CHECK_THROWS_AS(stored_map(large.mesh, large.places, WeightPrecision::kHalf), Error);
    CHECK(map_quality(large.mesh, stored_map(large.mesh, large.places, {})).flipped_triangles == 0);
}
