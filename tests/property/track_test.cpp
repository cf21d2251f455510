// What must hold for pixels that are carried through a collapse.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/metrics/metrics.h"
#include "libcore/param/track.h"
#include "libcore/param/track_start.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

using MapCheck = std::function<void(const BaseMesh&, const PixelMap&)>;

// Collapses an image level by level with a tracker beside it, and checks the map after each.
PixelTracker tracked(const FeatureImage& feature, const TrackParams& params,
                     const std::vector<std::int64_t>& vertices, const MapCheck& check) {
    const GridMesh grid = grid_mesh(feature);
    PixelTracker tracker(track_start(grid, feature.width, feature.height), params);
    std::vector<SimplifyTarget> targets;
    for (const std::int64_t v : vertices) targets.push_back({.vertices = v});
    SimplifyHooks hooks;
    hooks.before = [&](const CollapseStep& step) {
        return tracker.collapse(step.kept, step.removed, {step.x, step.y}, step.feature);
    };
    hooks.reached = [&](std::size_t, const SimplifyResult& result) {
        check(result.mesh, tracker.map(result.mesh));
    };
    simplify(grid, plain_params(), targets, {}, hooks);
    return tracker;
}

// After about every tenth of the collapses.
std::vector<std::int64_t> many_levels(int pixels, std::int64_t last) {
    std::vector<std::int64_t> out;
    for (int k = 10; k >= 1; --k) out.push_back(std::max<std::int64_t>(last, pixels * k / 11));
    out.push_back(last);
    return out;
}

// The simplex, a face for each pixel, and pixels of a side exactly on that side.
void check_map(const BaseMesh& mesh, const PixelMap& map) {
    const MapQuality q = map_quality(mesh, map);
    CHECK(q.unmapped == 0);
    CHECK(q.outside_simplex == 0);
    const auto right = static_cast<float>(map.width - 1), bottom = static_cast<float>(map.height - 1);
    const auto stays = [&](const PixelCoord& coord, int axis, float side) {
        const auto& corners = mesh.faces[coord.face];
        const std::array<float, 3> weight{1 - coord.u - coord.v, coord.u, coord.v};
        for (std::size_t k = 0; k < 3; ++k)
            CHECK((weight[k] == 0 || mesh.position[corners[k]][axis] == side));
    };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const PixelCoord& coord = map.row(y)[static_cast<std::size_t>(x)];
            if (x == 0) stays(coord, 0, 0);
            if (x == map.width - 1) stays(coord, 0, right);
            if (y == 0) stays(coord, 1, 0);
            if (y == map.height - 1) stays(coord, 1, bottom);
        }
}

}  // namespace

TEST_CASE("track: weights stay in the simplex and sides on their side over a whole run") {
    for (const Kind kind : kAllKinds)
        for (const double weight : {0.0, 0.01, 1.0, 1e4}) {
            INFO(name_of(kind) << ", weight " << weight);
            TrackParams params;
            params.color_weight = weight;
            int checked = 0;
            tracked(sample_feature(kind, 33, 26), params, many_levels(33 * 26, 12),
                    [&](const BaseMesh& mesh, const PixelMap& map) {
                        check_map(mesh, map);
                        ++checked;
                    });
            CHECK(checked == 11);
        }
}

// With the plane's own metric flattening changes nothing, so carrying changes nothing either.
TEST_CASE("track: without colour every pixel stays where it is") {
    for (const Kind kind : {Kind::kConstant, Kind::kGradient, Kind::kDisc}) {
        INFO(name_of(kind));
        TrackParams params;
        params.color_weight = 0;
        tracked(sample_feature(kind, 40, 31), params, many_levels(40 * 31, 20),
                [&](const BaseMesh& mesh, const PixelMap& map) {
                    const MapQuality q = map_quality(mesh, map);
                    CHECK(q.max_displacement < 2e-3);
                    CHECK(q.flipped_triangles == 0);
                });
    }
    // Nor does any weight of a colour that is the same everywhere.
    TrackParams heavy;
    heavy.color_weight = 100;
    tracked(sample_feature(Kind::kConstant, 40, 31), heavy, {200, 20},
            [&](const BaseMesh& mesh, const PixelMap& map) {
                CHECK(map_quality(mesh, map).max_displacement < 2e-3);
            });
}

TEST_CASE("track: in the plane every pixel is where it was, whatever the image, and nothing is forbidden") {
    TrackParams params;
    params.space = TrackSpace::kPlane;
    for (const Kind kind : kAllKinds) {
        INFO(name_of(kind));
        const PixelTracker tracker = tracked(sample_feature(kind, 40, 31), params, many_levels(40 * 31, 20),
                                             [&](const BaseMesh& mesh, const PixelMap& map) {
                                                 check_map(mesh, map);
                                                 CHECK(map_quality(mesh, map).max_displacement < 1e-4);
                                             });
        CHECK(tracker.rejected() == 0);
    }
}

// The purpose of the tracked map is to follow colours.
TEST_CASE("track: colour weight brings a map that is closer to the image than none") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 60, 50);
    double with = 0, without = 0;
    const auto rms_into = [&](double& out) {
        return [&](const BaseMesh& mesh, const PixelMap& map) { out = map_rms(mesh, map, feature); };
    };
    TrackParams params;
    tracked(feature, params, {40}, rms_into(with));
    params.color_weight = 0;
    tracked(feature, params, {40}, rms_into(without));
    CHECK(with < 0.8 * without);
}

// Noise has colours so far apart and so heavily weighted here that layouts fold.
TEST_CASE("track: collapses are rejected where the flattened mesh would degenerate") {
    TrackParams params;
    params.color_weight = 1e4;
    const PixelTracker tracker = tracked(sample_feature(Kind::kNoise, 33, 26), params, {12}, check_map);
    CHECK(tracker.rejected() > 0);
}

namespace {

PixelTracker flat_tracker(int width, int height, TrackSpace space) {
    const FeatureImage feature{width, height, 3,
                               std::vector<float>(static_cast<std::size_t>(3 * width * height))};
    TrackParams params;
    params.space = space;
    return PixelTracker(track_start(grid_mesh(feature), width, height), params);
}

}  // namespace

// Pixels of a 5 x 5 grid, cells cut from top left to bottom right:    0  1  2  3  4
// first 12 and 13 merge, then the new vertex and 17.                  5  6  7  8  9
//                                                                    10 11 12 13 14 ...
TEST_CASE("track: a pixel counts as an end, and whenever it is projected anew") {
    const std::vector<float> grey{0, 0, 0};
    for (const TrackSpace space : {TrackSpace::kConformal, TrackSpace::kPlane}) {
        PixelTracker tracker = flat_tracker(5, 5, space);
        std::vector<Id> expected(25, 0);
        REQUIRE(tracker.collapse(12, 13, {2.5f, 2.0f}, grey));
        expected[12] = expected[13] = 1;
        CHECK(tracker.visits() == expected);
        // 12 is no pixel any more, but both pixels lie in faces around it; 17 is an end for the first time.
        REQUIRE(tracker.collapse(12, 17, {2.25f, 2.5f}, grey));
        expected[12] = expected[13] = 2;
        expected[17] = 1;
        CHECK(tracker.visits() == expected);
        // Far from the rest: 1 slides to 2 along the side.
        REQUIRE(tracker.collapse(1, 2, {1.5f, 0.0f}, grey));
        expected[1] = expected[2] = 1;
        CHECK(tracker.visits()[1] == 1);
        CHECK(tracker.visits()[2] == 1);
        CHECK(tracker.visits()[24] == 0);
    }
}

// A hook that rejects nothing changes nothing.
TEST_CASE("collapse hooks: called for each collapse in order, and their word counts") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 30, 20);
    const GridMesh grid = grid_mesh(feature);
    const std::vector<SimplifyTarget> targets{{.vertices = 100}, {.vertices = 30}};
    const std::vector<SimplifyResult> plain =
        simplify(grid, plain_params_but([](auto& p) { p.tiles = false; }), targets);
    std::int64_t calls = 0;
    std::vector<std::int64_t> calls_at_level;
    SimplifyHooks hooks;
    hooks.before = [&](const CollapseStep& step) {
        ++calls;
        CHECK(step.kept != step.removed);
        CHECK(step.feature.size() == 3);
        return true;
    };
    hooks.reached = [&](std::size_t level, const SimplifyResult& result) {
        CHECK(level == calls_at_level.size());
        CHECK(result.collapses == calls);
        calls_at_level.push_back(calls);
    };
    const std::vector<SimplifyResult> followed = simplify(grid, plain_params(), targets, {}, hooks);
    CHECK(calls_at_level == std::vector<std::int64_t>{500, 570});
    for (std::size_t k = 0; k < 2; ++k) {
        CHECK(followed[k].mesh.position == plain[k].mesh.position);
        CHECK(followed[k].mesh.feature == plain[k].mesh.feature);
        CHECK(followed[k].mesh.faces == plain[k].mesh.faces);
    }
    hooks.before = [](const CollapseStep&) { return false; };
    hooks.reached = {};
    CHECK(simplify(grid, plain_params(), targets, {}, hooks).back().collapses == 0);
}
