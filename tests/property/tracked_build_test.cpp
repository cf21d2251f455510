// Tracked maps and visits through the whole pipeline.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/pipeline/build.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

BuildParams with_map(MapKind kind, double density = 5) {
    BuildParams params;
    params.map = kind;
    params.stop.density = density;
    return params;
}

bool on_grid(const PixelMap& map) {
    const double steps = map.precision == WeightPrecision::kHalf ? 2048 : 16777216;
    for (const PixelCoord& c : map)
        for (const double w : {double(c.u) * steps, double(c.v) * steps})
            if (w != std::floor(w)) return false;
    return true;
}

std::optional<ErrorKind> failure(const BuildParams& params) {
    try {
        build_mesh_image(sample_picture(Kind::kDisc, 12, 9), params);
    } catch (const Error& error) {
        return error.kind();
    }
    return std::nullopt;
}

}  // namespace

TEST_CASE("tracked build: all kinds and sizes of images, and both precisions") {
    for (const Kind kind : kAllKinds)
        for (const auto& [w, h] :
             {std::pair{1, 1}, {1, 2}, {2, 1}, {2, 2}, {1, 30}, {30, 1}, {3, 3}, {5, 7}, {40, 30}})
            for (const WeightPrecision precision : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
                INFO(name_of(kind) << " " << w << " x " << h);
                BuildParams params = with_map(MapKind::kTracked);
                params.visits = true;
                params.bary = precision;
                const MeshImage built = build_mesh_image(sample_picture(kind, w, h), params).mesh_image;
                const Level& level = built.levels.front();
                const MapQuality q = map_quality(level.mesh, level.map);
                CHECK(q.pixels == w * h);
                CHECK(q.unmapped + q.outside_simplex == 0);
                CHECK(level.map.precision == precision);
                CHECK(on_grid(level.map));
                CHECK(built.visits.size() == static_cast<std::size_t>(w * h));
            }
}

// Halves step by 1/2048 of an edge: for edges up to 256 px that is at most an eighth of a pixel.
TEST_CASE("tracked build: halves serve small faces, floats large ones") {
    for (const int width : {200, 300}) {
        BaseMesh mesh;
        const auto right = static_cast<float>(width - 1);
        mesh.position = {{0, 0}, {0, 3}, {right, 3}, {right, 0}};
        mesh.feature.assign(12, 50.0f);
        mesh.faces = {{0, 1, 2}, {0, 2, 3}};
        const PixelMap map =
            fit_given_map(mesh, sample_feature(Kind::kDisc, width, 4), trivial_map(mesh, width, 4), {});
        CHECK(map.precision == (width == 200 ? WeightPrecision::kHalf : WeightPrecision::kFloat));
        CHECK(on_grid(map));
    }
}

TEST_CASE("tracked build: each level has its own map, closer to the image than the trivial one") {
    const Image image = sample_picture(Kind::kDisc, 60, 50);
    BuildParams params = with_map(MapKind::kTracked, 3);
    params.levels.count = 2;
    params.refine = 0;
    const BuildResult tracked = build_mesh_image(image, params);
    params.map = MapKind::kTrivial;
    const BuildResult trivial = build_mesh_image(image, params);
    REQUIRE(tracked.mesh_image.levels.size() == 2);
    const FeatureImage feature = luv_image(image);
    for (std::size_t k = 0; k < 2; ++k) {
        INFO("level " << k);
        const Level& level = tracked.mesh_image.levels[k];
        CHECK(map_quality(level.mesh, level.map).unmapped == 0);
        CHECK(tracked.report.levels[k].map_rms == map_rms(level.mesh, level.map, feature));
        CHECK(tracked.report.levels[k].map_rms < trivial.report.levels[k].map_rms);
    }
    // In the trivial map only rounding separates a pixel from its place.
    const Level& level = trivial.mesh_image.levels[1];
    CHECK(map_quality(level.mesh, level.map).max_displacement < 0.1);
}

TEST_CASE("tracked build: the same result for any number of threads") {
    const Image image = sample_picture(Kind::kNoise, 60, 80);
    BuildParams params = with_map(MapKind::kTracked);
    params.visits = true;
    const MeshImage first = build_mesh_image(image, params).mesh_image;
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        const MeshImage other = build_mesh_image(image, params).mesh_image;
        CHECK(other.levels[0].mesh.position == first.levels[0].mesh.position);
        CHECK(other.levels[0].mesh.feature == first.levels[0].mesh.feature);
        CHECK(other.levels[0].map.values == first.levels[0].map.values);
        CHECK(other.visits == first.visits);
    }
}

TEST_CASE("tracked build: masked images keep their mask to the pixel") {
    const Image image = sample_picture(Kind::kNoise, 40, 36);
    Mask ring{40, 36, std::vector<std::uint8_t>(40 * 36)}, specks = ring;
    for (int y = 0; y < 36; ++y)
        for (int x = 0; x < 40; ++x) {
            const auto i = static_cast<std::size_t>(y * 40 + x);
            const int r = (x - 20) * (x - 20) + (y - 18) * (y - 18);
            ring[i] = r > 30 && r < 260;
            // Islands that touch at corners, single pixels, lines one pixel wide.
            specks[i] = (x / 5 + y / 5) % 2 == 0 || x == 33 || (x % 7 == 3 && y % 11 == 2);
        }
    for (const Mask& mask : {ring, specks})
        for (const MapKind kind : {MapKind::kTracked, MapKind::kRelaxed}) {
            BuildParams params = with_map(kind, 12);
            params.visits = true;
            params.levels.count = 2;
            const MeshImage built = build_mesh_image(image, params, {}, mask).mesh_image;
            for (const Level& level : built.levels) {
                for (std::size_t i = 0; i < mask.size(); ++i)
                    CHECK((level.map[i].face != kNone) == (mask[i] != 0));
                const MapQuality q = map_quality(level.mesh, level.map, true);
                CHECK(q.unmapped + q.outside_simplex == 0);
            }
            for (std::size_t i = 0; i < mask.size(); ++i)
                if (mask[i] == 0) CHECK(built.visits[i] == 0);
        }
}

TEST_CASE("tracked build: visits belong to the finest level and leave the relaxed map alone") {
    const Image image = sample_picture(Kind::kNoise, 40, 30);
    BuildParams params = with_map(MapKind::kRelaxed, 10);
    CHECK(build_mesh_image(image, params).mesh_image.visits.empty());
    params.visits = true;
    const MeshImage one = build_mesh_image(image, params).mesh_image;
    params.levels.count = 3;
    const MeshImage three = build_mesh_image(image, params).mesh_image;
    CHECK(one.visits == three.visits);
    CHECK(map_quality(one.levels[0].mesh, one.levels[0].map).flipped_triangles == 0);
    // 90 % of the vertices are removed, so nearly all pixels were an end, and some were touched again.
    std::int64_t sum = 0;
    for (const Id v : one.visits) sum += v;
    CHECK(sum > 2 * 40 * 30);
}

TEST_CASE("tracked build: contradictions are refused as wrong use") {
    for (const MapKind kind : {MapKind::kTracked, MapKind::kRelaxed}) {
        BuildParams p = with_map(kind);
        p.projection_color_weight = 0;
        CHECK(failure(p) == ErrorKind::kBadArgument);
        p.projection_color_weight = 1e-9;
        CHECK_FALSE(failure(p));
    }
    BuildParams trivial = with_map(MapKind::kTrivial);
    trivial.projection_color_weight = 0.5;
    CHECK(failure(trivial) == ErrorKind::kBadArgument);
    trivial.projection_color_weight = 0;
    CHECK_FALSE(failure(trivial));
    BuildParams refined = with_map(MapKind::kTracked);
    refined.refine = 1;
    CHECK(failure(refined) == ErrorKind::kBadArgument);
}

TEST_CASE("tracked build: which map it is, is listed") {
    const auto listed = [](const BuildParams& params) {
        std::string map;
        double weight = -1;
        for (const auto& [key, value] :
             build_mesh_image(sample_picture(Kind::kDisc, 12, 9), params).mesh_image.parameters) {
            if (key == "map") map = std::get<std::string>(value);
            if (key == "projection-color-weight") weight = std::get<double>(value);
        }
        return std::pair(map, weight);
    };
    BuildParams zero;
    zero.projection_color_weight = 0;
    CHECK(listed({}) == std::pair<std::string, double>("relaxed", 0.05));
    CHECK(listed(zero) == std::pair<std::string, double>("trivial", 0));
    CHECK(listed(with_map(MapKind::kTrivial)) == std::pair<std::string, double>("trivial", 0));
    CHECK(listed(with_map(MapKind::kTracked)) == std::pair<std::string, double>("tracked", 0.1));
}
