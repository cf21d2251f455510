// What must hold for pictures of any number of features.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// The features with those of `other` behind.
FeatureImage joined(const FeatureImage& first, const FeatureImage& second) {
    FeatureImage out{first.width, first.height, first.channels + second.channels, {}};
    for (std::size_t i = 0; i < first.pixel_count(); ++i) {
        out.data.insert(out.data.end(), first.pixel(i), first.pixel(i) + first.channels);
        out.data.insert(out.data.end(), second.pixel(i), second.pixel(i) + second.channels);
    }
    return out;
}

FeatureImage zeros(int width, int height, int channels) {
    FeatureImage out{width, height, channels, {}};
    out.data.assign(out.pixel_count() * static_cast<std::size_t>(channels), 0.0f);
    return out;
}

// Independent smooth waves with a step each.
FeatureImage waves(int width, int height, int channels) {
    FeatureImage out = zeros(width, height, channels);
    for (std::size_t i = 0; i < out.pixel_count(); ++i)
        for (int c = 0; c < channels; ++c) {
            const auto x = static_cast<float>(i % static_cast<std::size_t>(width)),
                       y = static_cast<float>(i / static_cast<std::size_t>(width));
            const auto k = static_cast<float>(c);
            out.pixel(i)[c] = 20 * std::sin(0.1f * (k + 1) * x + 0.3f * k * y) + (x + k > y ? 30.0f : 0.0f);
        }
    return out;
}

FeatureSpace plain_space(int channels) {
    FeatureSpace space;
    space.color = false;
    space.plain.assign(static_cast<std::size_t>(channels), "x");
    space.plain_weight.assign(static_cast<std::size_t>(channels), 1.0f);
    return space;
}

struct Fitted {
    BaseMesh mesh;
    PixelMap map;
};

Fitted fitted(const FeatureImage& feature, std::int64_t vertices, const FeatureSpace& space) {
    Fitted out;
    out.mesh = collapse_edges(grid_mesh(feature), {}, CollapseTarget{.vertices = vertices}).mesh;
    FitParams params;
    params.space = space;
    out.map = fit_map(out.mesh, feature, params);
    return out;
}

}  // namespace

// The code for other numbers than three is another one; features of zero error must not be seen by any of it.
TEST_CASE("channels: features that are zero everywhere change nothing, to the bit") {
    for (const Kind kind : {Kind::kDisc, Kind::kGradient, Kind::kNoise}) {
        const FeatureImage color = sample_feature(kind, 45, 34);
        const Fitted expected = fitted(color, 40, {});
        for (const int more : {1, 5, 13}) {
            INFO(name_of(kind) << ", " << more << " more");
            FeatureSpace space = plain_space(more);
            space.color = true;
            const Fitted got = fitted(joined(color, zeros(45, 34, more)), 40, space);
            CHECK(got.mesh.position == expected.mesh.position);
            CHECK(got.mesh.faces == expected.mesh.faces);
            CHECK(got.map.coords == expected.map.coords);
            REQUIRE(got.mesh.channels == 3 + more);
            for (Id v = 0; v < got.mesh.vertex_count(); ++v) {
                CHECK(std::equal(got.mesh.feature_of(v), got.mesh.feature_of(v) + 3,
                                 expected.mesh.feature_of(v)));
                CHECK(std::all_of(got.mesh.feature_of(v) + 3, got.mesh.feature_of(v) + 3 + more,
                                  [](float x) { return x == 0; }));
            }
        }
    }
}

TEST_CASE("channels: any number gives a sound mesh, and a map without a fold that is better than none") {
    for (const int channels : {1, 2, 3, 4, 8, 9, 16}) {
        INFO(channels << " channels");
        const FeatureImage feature = waves(40, 30, channels);
        const Fitted got = fitted(feature, 60, plain_space(channels));
        CHECK(got.mesh.channels == channels);
        CHECK(mesh_quality(got.mesh).flipped_faces == 0);
        CHECK(mesh_quality(got.mesh).euler == 1);
        CHECK(map_quality(got.mesh, got.map).flipped_triangles == 0);
        BaseMesh still = got.mesh;
        FitParams rest;
        rest.color_weight = 0;
        rest.space = plain_space(channels);
        const PixelMap trivial = fit_map(still, feature, rest);
        CHECK(map_rms(got.mesh, got.map, feature) < map_rms(still, trivial, feature));
    }
}

// Twice the features is twice the errors; a weight of four is sqrt(16) times the same one.
TEST_CASE("channels: the same channel sixteen times counts as one of four times the size") {
    const FeatureImage one = waves(40, 30, 1);
    FeatureImage large = one, many = zeros(40, 30, 16);
    for (float& x : large.data) x *= 4;
    for (std::size_t i = 0; i < many.pixel_count(); ++i) std::fill_n(many.pixel(i), 16, one.pixel(i)[0]);
    const Fitted a = fitted(large, 60, plain_space(1)), b = fitted(many, 60, plain_space(16));
    CHECK(map_rms(a.mesh, a.map, large) == doctest::Approx(map_rms(b.mesh, b.map, many)).epsilon(0.05));
}

TEST_CASE("channels: a constant one is reproduced exactly enough") {
    FeatureImage feature = joined(waves(30, 20, 1), zeros(30, 20, 1));
    for (std::size_t i = 0; i < feature.pixel_count(); ++i) feature.pixel(i)[1] = 1e4f;
    const Fitted got = fitted(feature, 30, plain_space(2));
    for (Id v = 0; v < got.mesh.vertex_count(); ++v)
        CHECK(got.mesh.feature_of(v)[1] == doctest::Approx(1e4).epsilon(1e-6));
}

TEST_CASE("channels: none and too many are refused") {
    for (const int channels : {0, 17})
        CHECK_THROWS_AS(collapse_edges(grid_mesh(zeros(8, 8, channels)), {}, CollapseTarget{.vertices = 9}),
                        Error);
}
