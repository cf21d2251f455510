// What must hold for images of any number of features.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/pipeline/build.h"
#include "libcore/recon/draw_channels.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// The features followed by those of `other`.
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

// Independent smooth waves, each with a step.
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

FeatureSpace auxiliary_space(int channels) {
    FeatureSpace space;
    space.color = false;
    space.auxiliary.assign(static_cast<std::size_t>(channels), "x");
    space.auxiliary_weight.assign(static_cast<std::size_t>(channels), 1.0f);
    return space;
}

struct Fitted {
    BaseMesh mesh;
    PixelMap map;
};

Fitted fitted(const FeatureImage& feature, std::int64_t vertices, const FeatureSpace& space,
              int steps = kUsualSteps) {
    Fitted out;
    out.mesh = simplify(grid_mesh(feature), plain_params(), SimplifyTarget{.vertices = vertices}).mesh;
    FitParams params;
    params.space = space;
    params.steps = steps;
    out.map = fit_map(out.mesh, feature, params);
    return out;
}

}  // namespace

// Other numbers than three have other code; features of zero error must make no difference to any of it. Not
// with ties: eight quadrics of three features at a time sum in another order, and last bits decide between
// equals.
TEST_CASE("channels: features that are zero everywhere change nothing, to the bit") {
    for (const Kind kind : {Kind::kGradient, Kind::kNoise}) {
        const FeatureImage color = sample_feature(kind, 45, 34);
        const Fitted expected = fitted(color, 40, {});
        for (const int more : {1, 5, 13}) {
            INFO(name_of(kind) << ", " << more << " more");
            FeatureSpace space = auxiliary_space(more);
            space.color = true;
            const Fitted got = fitted(joined(color, zeros(45, 34, more)), 40, space);
            CHECK(got.mesh.position == expected.mesh.position);
            CHECK(got.mesh.faces == expected.mesh.faces);
            CHECK(got.map.values == expected.map.values);
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
        const Fitted got = fitted(feature, 60, auxiliary_space(channels));
        CHECK(got.mesh.channels == channels);
        CHECK(mesh_quality(got.mesh).flipped_faces == 0);
        CHECK(mesh_quality(got.mesh).euler == 1);
        CHECK(map_quality(got.mesh, got.map).flipped_triangles == 0);
        BaseMesh still = got.mesh;
        FitParams rest;
        rest.color_weight = 0;
        rest.space = auxiliary_space(channels);
        const PixelMap trivial = fit_map(still, feature, rest);
        CHECK(map_rms(got.mesh, got.map, feature) < map_rms(still, trivial, feature));
    }
}

// Twice the features give twice the errors; a weight of four equals sqrt(16) copies of the feature.
TEST_CASE("channels: the same channel sixteen times counts as one of four times the size") {
    const FeatureImage one = waves(40, 30, 1);
    FeatureImage large = one, many = zeros(40, 30, 16);
    for (float& x : large.data) x *= 4;
    for (std::size_t i = 0; i < many.pixel_count(); ++i) std::fill_n(many.pixel(i), 16, one.pixel(i)[0]);
    const Fitted a = fitted(large, 60, auxiliary_space(1), 32), b = fitted(many, 60, auxiliary_space(16), 32);
    CHECK(map_rms(a.mesh, a.map, large) == doctest::Approx(map_rms(b.mesh, b.map, many)).epsilon(0.05));
}

TEST_CASE("channels: a constant one is reproduced exactly enough") {
    FeatureImage feature = joined(waves(30, 20, 1), zeros(30, 20, 1));
    for (std::size_t i = 0; i < feature.pixel_count(); ++i) feature.pixel(i)[1] = 1e4f;
    const Fitted got = fitted(feature, 30, auxiliary_space(2));
    for (Id v = 0; v < got.mesh.vertex_count(); ++v)
        CHECK(got.mesh.feature_of(v)[1] == doctest::Approx(1e4).epsilon(1e-6));
}

TEST_CASE("channels: none and too many are refused") {
    for (const int channels : {0, 17})
        CHECK_THROWS_AS(simplify(grid_mesh(zeros(8, 8, channels)), {}, SimplifyTarget{.vertices = 9}), Error);
}

namespace {

constexpr int kWidth = 64, kHeight = 48;

// Grey that changes slowly, and a depth with one oblique step that the colour does not show.
Image picture_with_depth() {
    Image image = make_image(kWidth, kHeight, 4);
    image.channel_names = {"R", "G", "B", "depth.Z"};
    image.color_space = ColorSpace::kLinear;
    image.sample_type = SampleType::kFloat;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            float* p = image.pixel(x, y);
            std::fill_n(p, 3, 0.3f + 0.002f * static_cast<float>(x));
            p[3] = 2 * x + y < 80 ? 1.0f : 3.0f;
        }
    return image;
}

BuildParams chosen(const std::vector<ChannelChoice>& channels, std::int64_t vertices = 40) {
    BuildParams params;
    params.channels = channels;
    params.stop.vertices = vertices;
    return params;
}

// The share of vertices within two pixels of the step.
double share_at_step(const BaseMesh& mesh) {
    std::size_t near = 0;
    for (const Vec2f& p : mesh.position) near += std::abs(2 * p.x() + p.y() - 79.5f) / std::sqrt(5.0f) < 2;
    return static_cast<double>(near) / static_cast<double>(mesh.vertex_count());
}

float largest_difference(const Image& a, const Image& b, const std::string& channel) {
    float largest = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x)
            largest = std::max(
                largest, std::abs(a.pixel(x, y)[a.channel(channel)] - b.pixel(x, y)[b.channel(channel)]));
    return largest;
}

}  // namespace

TEST_CASE("channels: the mesh follows an edge of depth that is none of colour") {
    const Image image = picture_with_depth();
    const std::vector<ChannelChoice> color = {{"R"}, {"G"}, {"B"}};
    std::vector<ChannelChoice> all = color;
    all.push_back({"depth.Z", 50});
    const BuildResult without = build_mesh_image(image, chosen(color)),
                      with = build_mesh_image(image, chosen(all));
    // The step is straight, so a few vertices on it are enough; vertices off it are useless.
    CHECK(share_at_step(without.mesh_image.levels[0].mesh) < 0.1);
    CHECK(share_at_step(with.mesh_image.levels[0].mesh) > 0.25);
    CHECK(with.mesh_image.source.channel_names == std::vector<std::string>{"R", "G", "B", "depth.Z"});
    // In the depth's own unit, whatever its weight: a step of 2 has a far smaller mean error.
    REQUIRE(with.report.levels[0].auxiliary_rms.size() == 1);
    CHECK(with.report.levels[0].auxiliary_rms[0] < 0.06);

    const Image drawn = draw_channels(with.mesh_image, 0, {});
    CHECK(drawn.channel_names == image.channel_names);
    CHECK(drawn.sample_type == SampleType::kFloat);
    CHECK(largest_difference(drawn, image, "G") < 0.01f);
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            sum += std::pow(double(drawn.pixel(x, y)[3] - image.pixel(x, y)[3]), 2);
    CHECK(std::sqrt(sum / (kWidth * kHeight)) ==
          doctest::Approx(with.report.levels[0].auxiliary_rms[0]).epsilon(1e-3));
}

TEST_CASE(
    "channels: the weights of all that is chosen, times four, with geometry's times sixteen, change "
    "nothing") {
    const Image image = picture_with_depth();
    BuildParams params = chosen({{"R"}, {"G"}, {"B"}, {"depth.Z", 16}});
    params.projection_color_weight = 1.0 / 30;
    BuildParams four = params;
    for (ChannelChoice& choice : four.channels) choice.weight *= 4;
    four.geometry_weight *= 16;
    four.projection_color_weight = 1.0 / 30 / 16;
    const MeshImage a = build_mesh_image(image, params).mesh_image,
                    b = build_mesh_image(image, four).mesh_image;
    CHECK(a.levels[0].mesh.faces == b.levels[0].mesh.faces);
    CHECK(a.levels[0].mesh.position == b.levels[0].mesh.position);
    for (std::size_t i = 0; i < a.levels[0].mesh.feature.size(); ++i)
        CHECK(a.levels[0].mesh.feature[i] == doctest::Approx(b.levels[0].mesh.feature[i]).epsilon(1e-4));
}

TEST_CASE("channels: refinement, which knows colour alone, is refused") {
    const Image image = picture_with_depth();
    BuildParams params = chosen({{"R"}, {"G"}, {"B"}, {"depth.Z"}});
    params.refine = 1;
    CHECK_THROWS_AS(build_mesh_image(image, params), Error);
    params.channels.pop_back();
    CHECK_NOTHROW(build_mesh_image(image, params));
    Image light = image;
    light.data[0] = 2;
    CHECK_THROWS_AS(build_mesh_image(light, params), Error);
}

TEST_CASE("channels: a mesh without colour is drawn as its channels, and not as colour") {
    const Image image = picture_with_depth();
    const MeshImage built = build_mesh_image(image, chosen({{"depth.Z", 20}})).mesh_image;
    CHECK(built.levels[0].mesh.channels == 1);
    for (const DrawMode mode : {DrawMode::kMap, DrawMode::kGouraud}) {
        const Image drawn = draw_channels(built, 0, {mode});
        CHECK(drawn.channel_names == std::vector<std::string>{"depth.Z"});
        CHECK(drawn.pixel(2, 2)[0] == doctest::Approx(1).epsilon(0.02));
        CHECK(drawn.pixel(60, 40)[0] == doctest::Approx(3).epsilon(0.02));
        CHECK_THROWS_AS(draw(built, 0, {mode}), Error);
    }
    CHECK_THROWS_AS(draw_channels(built, 0, {DrawMode::kWire}), Error);
    CHECK_THROWS_AS(draw_channels(built, 1, {}), Error);
    CHECK_THROWS_AS(draw_channels(built, 0, {DrawMode::kMap, 2}), Error);
    CHECK(draw_channels(built, 0, {DrawMode::kGouraud, 2}).width == 2 * kWidth);
}

TEST_CASE("channels: grey with a channel keeps its name, and pixels outside the mask are 0") {
    Image image = make_image(12, 9, 2);
    image.channel_names = {"Y", "Z"};
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = i % 2 ? 5.0f : 0.5f;
    MeshImage built = build_mesh_image(image, chosen({{"Y"}, {"Z"}}, 4)).mesh_image;
    CHECK(built.levels[0].mesh.channels == 4);
    Image drawn = draw_channels(built, 0, {});
    CHECK(drawn.channel_names == std::vector<std::string>{"Y", "Z"});
    CHECK(drawn.pixel(3, 3)[0] == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(drawn.pixel(3, 3)[1] == doctest::Approx(5).epsilon(1e-5));
    built.source.has_mask = true;
    built.levels[0].map[0] = {};
    drawn = draw_channels(built, 0, {});
    CHECK(drawn.channel_names == std::vector<std::string>{"Y", "A", "Z"});
    CHECK(drawn.pixel(0, 0)[1] == 0);
    CHECK(drawn.pixel(0, 0)[2] == 0);
    CHECK(drawn.pixel(1, 0)[1] == 1);
}

TEST_CASE("light: highlights above 1 come back, in half and float images, and are clipped in others") {
    Image image = make_image(kWidth, kHeight, 3);
    image.color_space = ColorSpace::kLinear;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const bool lamp = (x - 40) * (x - 40) + (y - 20) * (y - 20) < 60;
            const float light[3] = {lamp ? 80.0f : 0.2f, lamp ? 40.0f : 0.25f, lamp ? 20.0f : -0.1f};
            std::copy_n(light, 3, image.pixel(x, y));
        }
    for (const SampleType type : {SampleType::kUint16, SampleType::kHalf, SampleType::kFloat}) {
        image.sample_type = type;
        const MeshImage built = build_mesh_image(image, chosen({}, 60)).mesh_image;
        const bool floats = type != SampleType::kUint16;
        CHECK(built.source.gamut == (floats ? Gamut::kHdr : Gamut::kDisplay));
        CHECK(map_quality(built.levels[0].mesh, built.levels[0].map).flipped_triangles == 0);
        const Image drawn = draw(built, 0, {});
        CHECK(drawn.pixel(40, 20)[0] == doctest::Approx(floats ? 80 : 1).epsilon(0.02));
        CHECK(drawn.pixel(40, 20)[2] == doctest::Approx(floats ? 20 : 1).epsilon(0.02));
        CHECK(drawn.pixel(5, 5)[1] == doctest::Approx(0.25).epsilon(0.02));
        CHECK(drawn.pixel(5, 5)[2] == doctest::Approx(0).epsilon(0.02));
        for (Id v = 0; v < built.levels[0].mesh.vertex_count(); ++v) {
            const Vec3f luv(built.levels[0].mesh.feature_of(v));
            CHECK(quantized_color(luv, built.source.gamut) == luv);
        }
    }
}

TEST_CASE("light: a float image within 0 and 1 is what an integer one is, to the bit") {
    Image image = sample_picture(Kind::kDisc, 40, 30);
    const Level expected = build_mesh_image(image, {}).mesh_image.levels[0];
    image.sample_type = SampleType::kFloat;
    const MeshImage built = build_mesh_image(image, {}).mesh_image;
    CHECK(built.levels[0].mesh.feature == expected.mesh.feature);
    CHECK(built.levels[0].map.values == expected.map.values);
    CHECK(built.source.gamut == Gamut::kDisplay);
}
