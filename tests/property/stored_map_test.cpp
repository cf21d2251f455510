// What must hold for the weights that a container holds of a map on a grid, of any image.
#include <doctest/doctest.h>

#include <random>

#include "libcore/base/error.h"
#include "libcore/mesh/grid_area.h"
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

TEST_CASE("stored map: what displacements come back fold no triangle either") {
    const auto folds = [](const Displacements& d) {
        const auto at = [&](int x, int y) {
            const std::size_t i = d.index(x, y);
            return Vec2d(x * d.steps + d.dx[i], y * d.steps + d.dy[i]);
        };
        const auto folded = [](const Vec2d& a, const Vec2d& b, const Vec2d& c) {
            return !(grid_area2(a, b, c) > 0);
        };
        int count = 0;
        for (int y = 0; y < 2; ++y)
            for (int x = 0; x < 2; ++x) {
                const Vec2d tl = at(x, y), tr = at(x + 1, y), bl = at(x, y + 1), br = at(x + 1, y + 1);
                count += folded(tl, tr, br) + folded(tl, br, bl) + folded(tl, tr, bl) + folded(tr, br, bl);
            }
        return count;
    };
    std::mt19937 random(1);
    int halves = 0;
    for (int i = 0; i < 20000; ++i) {
        Scene s = crowded(60 + i % 200);
        // On a finer grid: some steps apart, anywhere in the middle.
        s.places.steps = 32;
        const int side = 60 + i % 200;
        for (int k = 0; k < 9; ++k) {
            const int x = k % 3, y = k / 3, jitter = 7;
            s.places.dx[as_index(k)] =
                static_cast<std::int16_t>(side * 16 - 25 * x + static_cast<int>(random() % jitter));
            s.places.dy[as_index(k)] =
                static_cast<std::int16_t>(side * 8 - 25 * y + static_cast<int>(random() % jitter));
        }
        if (folds(s.places) > 0) continue;
        const PixelMap map = stored_map(s.mesh, s.places, {});
        halves += map.precision == WeightPrecision::kHalf;
        const std::optional<Displacements> back = displacements_of(s.mesh, map);
        REQUIRE(back.has_value());
        REQUIRE(folds(*back) == 0);
    }
    CHECK(halves > 100);
}

TEST_CASE("stored map: floats where half weights would fold, and an error where these are wanted") {
    const Scene small = crowded(16), large = crowded(1000);
    CHECK(stored_map(small.mesh, small.places, {}).precision == WeightPrecision::kHalf);
    CHECK(stored_map(large.mesh, large.places, {}).precision == WeightPrecision::kFloat);
    CHECK_THROWS_AS(stored_map(large.mesh, large.places, WeightPrecision::kHalf), Error);
    CHECK(map_quality(large.mesh, stored_map(large.mesh, large.places, {})).flipped_triangles == 0);
}
