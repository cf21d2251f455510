// What a container can hold: weights on a grid, and still no fold.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/quantize_map.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/meshes.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

struct Scene {
    BaseMesh mesh;
    std::vector<FaceField> fields;
    std::vector<Face> neighbors;
    PixelEmbedding pixels;

    std::optional<PixelMap> stored(WeightPrecision precision) const {
        return quantize_map(mesh, pixels, fields, neighbors, precision);
    }
};

Scene at_rest(BaseMesh mesh, int width, int height) {
    Scene s;
    s.mesh = std::move(mesh);
    s.fields = face_fields(s.mesh);
    s.neighbors = face_neighbors(s.mesh);
    s.pixels = resting_pixels(trivial_map(s.mesh, width, height));
    return s;
}

Scene relaxed(Kind kind, int width, int height, std::int64_t vertices, float smoothness) {
    const FeatureImage feature = sample_feature(kind, width, height);
    Scene s = at_rest(simplify(grid_mesh(feature), plain_params(), SimplifyTarget{.vertices = vertices}).mesh,
                      width, height);
    relax(s.pixels, s.fields, s.neighbors, feature, smoothness, 12);
    return s;
}

bool whole(double x) {
    return x == std::floor(x);
}

void check_storable(const Scene& s, const PixelMap& map, WeightPrecision precision) {
    const double steps = precision == WeightPrecision::kHalf ? 2048 : 16777216;
    CHECK(map.precision == precision);
    REQUIRE(map.size() == s.pixels.face.size());
    for (const PixelCoord& coord : map) {
        REQUIRE(coord.face < s.mesh.faces.size());
        const double u = double(coord.u), v = double(coord.v), w = 1 - u - v;
        CHECK(whole(u * steps));
        CHECK(whole(v * steps));
        CHECK(std::min({u, v, w}) >= 0);
        // The first weight, as single precision computes it, is exact as well.
        CHECK(double(1 - coord.u - coord.v) == w);
    }
    const MapQuality q = map_quality(s.mesh, map);
    CHECK(q.unmapped == 0);
    CHECK(q.outside_simplex == 0);
    CHECK(q.flipped_triangles == 0);
    CHECK(q.min_area2 >= kLeastStoredArea);
}

// Rounds weights one by one and ignores the triangles.
PixelMap carelessly_rounded(const Scene& s) {
    PixelMap map{s.pixels.width, s.pixels.height, {}, WeightPrecision::kHalf};
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const Id face = s.pixels.face[s.pixels.index(x, y)];
            const Vec2f p = s.pixels.image_of(x, y);
            const auto nearest = [](float w) { return std::round(w / kHalfWeightStep) * kHalfWeightStep; };
            map.values.push_back(
                {face, nearest(s.fields[face].u(p.x(), p.y())), nearest(s.fields[face].v(p.x(), p.y()))});
        }
    return map;
}

// Returns the largest distance between a pixel's place and its stored place.
double largest_move(const Scene& s, const PixelMap& map) {
    const std::vector<Vec2d> positions = mapped_positions(s.mesh, map);
    double largest = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x)
            largest = std::max(
                largest, (positions[s.pixels.index(x, y)] - s.pixels.image_of(x, y).cast<double>()).norm());
    return largest;
}

}  // namespace

TEST_CASE("quantized map: both grids hold the relaxed map of any image without a fold") {
    for (const Kind kind : kAllKinds)
        for (const float smoothness : {0.01f, 30.0f}) {
            const Scene s = relaxed(kind, 48, 36, 30, smoothness);
            for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
                INFO(name_of(kind) << ", smoothness " << smoothness << ", "
                                   << std::string(precision == WeightPrecision::kHalf ? "half" : "float"));
                const std::optional<PixelMap> map = s.stored(precision);
                REQUIRE(map.has_value());
                check_storable(s, *map, precision);
                // Single precision needs no repair; the half grid is some hundredths of a pixel wide here.
                CHECK(largest_move(s, *map) < (precision == WeightPrecision::kHalf ? 0.5 : 1e-4));
            }
        }
}

TEST_CASE("quantized map: at rest every pixel stays, to the step of the weights") {
    const Scene s = at_rest(jittered_grid(0, 0, 39, 29, 6, 5, 3), 40, 30);
    const double step = 1 / 2048.0;
    const std::optional<PixelMap> half = s.stored(WeightPrecision::kHalf),
                                  full = s.stored(WeightPrecision::kFloat);
    REQUIRE((half && full));
    check_storable(s, *half, WeightPrecision::kHalf);
    check_storable(s, *full, WeightPrecision::kFloat);
    CHECK(largest_move(s, *half) < 15 * step);  // faces are at most some 11 pixels across
    CHECK(largest_move(s, *full) < 1e-5);
}

// 1300 px / 2048 is more than half a pixel: neighbours fall onto each other, wherever they are moved.
TEST_CASE("quantized map: a face too large for half weights needs float ones") {
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 3}, {2600, 3}, {2600, 0}};
    mesh.feature.assign(12, 0.0f);
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    const Scene s = at_rest(mesh, 2601, 4);
    CHECK_FALSE(s.stored(WeightPrecision::kHalf).has_value());
    const std::optional<PixelMap> full = s.stored(WeightPrecision::kFloat);
    REQUIRE(full.has_value());
    check_storable(s, *full, WeightPrecision::kFloat);
}

TEST_CASE("quantized map: the few cells that rounding folds are repaired") {
    constexpr int kWidth = 241, kHeight = 121;
    const FeatureImage feature = sample_feature(Kind::kNoise, kWidth, kHeight);
    BaseMesh mesh = jittered_grid(0, 0, kWidth - 1, kHeight - 1, 2, 1, 5);
    for (Id v = 0; v < mesh.vertex_count(); ++v) mesh.feature_of(v)[0] = static_cast<float>(20 * v);
    Scene s = at_rest(mesh, kWidth, kHeight);
    relax(s.pixels, s.fields, s.neighbors, feature, 50.0f, 12);
    CHECK(map_quality(s.mesh, carelessly_rounded(s)).min_area2 < kLeastStoredArea);
    const std::optional<PixelMap> map = s.stored(WeightPrecision::kHalf);
    REQUIRE(map.has_value());
    check_storable(s, *map, WeightPrecision::kHalf);
    CHECK(largest_move(s, *map) < 1);
}
