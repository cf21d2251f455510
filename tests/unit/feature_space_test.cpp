#include "libcore/image/feature_space.h"

#include <doctest/doctest.h>
#include <optional>

#include <cmath>
#include <random>

#include "libcore/base/error.h"

using namespace imgmesh;

namespace {

// R, G, B, depth.Z, N.X, N.Y with values of their own.
Image picture() {
    Image image = make_image(3, 2, 6);
    image.channel_names = {"R", "G", "B", "depth.Z", "N.X", "N.Y"};
    image.color_space = ColorSpace::kLinear;
    image.sample_type = SampleType::kFloat;
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = static_cast<float>(i) / 20;
    return image;
}

std::optional<ErrorKind> refusal(const Image& image, const std::vector<ChannelChoice>& choices) {
    try {
        extract_features(image, feature_space(image, choices));
    } catch (const Error& error) {
        return error.kind();
    }
    return std::nullopt;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("feature space: R, G and B together are the colour, wherever they stand, else Y is") {
    CHECK(split_names({"R", "G", "B"}).color == Names{"R", "G", "B"});
    CHECK(split_names({"Z", "B", "Y", "R", "G"}).color == Names{"R", "G", "B"});
    CHECK(split_names({"Z", "B", "Y", "R", "G"}).auxiliary == Names{"Z", "Y"});
    CHECK(split_names({"R", "Y", "B"}).color == Names{"Y"});
    CHECK(split_names({"R", "Y", "B"}).auxiliary == Names{"R", "B"});
    CHECK(split_names({"R", "B"}).color.empty());
    CHECK(split_names({"R", "B"}).features() == 2);
    CHECK(split_names({"Y", "B"}).features() == 4);
}

TEST_CASE("feature space: values times weights, colour as L*u*v*") {
    const Image image = picture();
    const FeatureSpace space =
        feature_space(image, {{"N.X", 2}, {"R", 0.5}, {"B", 0.5}, {"depth.Z", 100}, {"G", 0.5}});
    const FeatureImage features = extract_features(image, space);
    const FeatureImage luv = luv_image(image);
    CHECK(space.gamut == Gamut::kHdr);
    REQUIRE(features.channels == 5);
    for (std::size_t i = 0; i < features.pixel_count(); ++i) {
        for (int c = 0; c < 3; ++c) CHECK(features.pixel(i)[c] == 0.5f * luv.pixel(i)[c]);
        CHECK(features.pixel(i)[3] == 2 * image.data[6 * i + 4]);
        CHECK(features.pixel(i)[4] == 100 * image.data[6 * i + 3]);
    }
    // Nothing chosen: only the colour.
    CHECK(extract_features(image, feature_space(image, {})).data == luv.data);
    CHECK(extract_features(image, feature_space(image, {{"depth.Z"}})).data[1] == image.data[9]);
}

TEST_CASE("feature space: what is refused, and how") {
    const Image image = picture();
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    CHECK(refusal(image, {{"depth.Z"}}) == std::nullopt);
    CHECK(refusal(image, {{"depth.z"}}) == ErrorKind::kBadFile);
    CHECK(refusal(image, {{"N.X"}, {"N.X", 2}}) == ErrorKind::kBadArgument);
    for (const double weight : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()})
        CHECK(refusal(image, {{"depth.Z", weight}}) == ErrorKind::kBadArgument);
    CHECK(refusal(image, {{"R", 1}, {"G", 2}, {"B", 1}}) == ErrorKind::kBadArgument);
    CHECK(refusal(image, {{"R", 1}, {"G", 2}}) == std::nullopt);  // two channels, no colour
    CHECK(refusal(image, {{"depth.Z", 1e9}}) == ErrorKind::kUnsupported);
    Image nothing = picture();
    nothing.data[3] = std::numeric_limits<float>::quiet_NaN();
    CHECK(refusal(nothing, {{"depth.Z"}}) == ErrorKind::kUnsupported);

    Image many = make_image(2, 2, 17);
    std::vector<ChannelChoice> all;
    for (const std::string& name : many.channel_names) all.push_back({name});
    CHECK(refusal(many, all) == ErrorKind::kBadArgument);
    all.pop_back();
    CHECK(refusal(many, all) == std::nullopt);
    CHECK(refusal(many, {}) == ErrorKind::kUnsupported);
    // A colour counts as three.
    many.channel_names[15] = "Y";
    all.back().name = "Y";
    CHECK(refusal(many, all) == ErrorKind::kBadArgument);
}

TEST_CASE("gamut: light counts where floats have more than 1, in linear light") {
    Image image = make_image(2, 1, 3);
    image.color_space = ColorSpace::kLinear;
    image.data = {0, 0, 0, 1, 1, 1};
    for (const SampleType type :
         {SampleType::kUint8, SampleType::kUint16, SampleType::kHalf, SampleType::kFloat}) {
        image.sample_type = type;
        image.data[4] = 1;
        CHECK(gamut_of(image) == Gamut::kDisplay);
        image.data[4] = 1.001f;
        const bool floats = type == SampleType::kHalf || type == SampleType::kFloat;
        CHECK(gamut_of(image) == (floats ? Gamut::kHdr : Gamut::kDisplay));
    }
    image.channel_names = {"X", "Y", "Z"};
    CHECK(gamut_of(image) == Gamut::kHdr);
    image.channel_names = {"R", "G", "Z"};
    CHECK(gamut_of(image) == Gamut::kDisplay);  // no colour
}

namespace {

// HDR values of all sizes and hues, some of only one or two primaries.
Vec3f random_light(std::mt19937& random) {
    Vec3f light;
    for (float& x : light) x = std::uniform_real_distribution<float>(0, 1)(random);
    if (random() % 4 == 0) light[static_cast<Eigen::Index>(random() % 3)] = 0;
    if (random() % 4 == 0) light[static_cast<Eigen::Index>(random() % 3)] *= 1e-3f;
    return light * std::pow(10.0f, std::uniform_real_distribution<float>(-6, 6)(random));
}

}  // namespace

TEST_CASE("light: what is stored is close, is not negative, and is stored again as the same bits") {
    std::mt19937 random(1);
    for (int n = 0; n < 20000; ++n) {
        Vec3f light = random_light(random);
        // Powers of two, where the step changes, and a little below.
        if (n % 4 == 0) light[1] = std::ldexp(1 - static_cast<float>(n % 3) * 1e-6f, std::ilogb(light[1]));
        INFO("light " << light.transpose());
        const Vec3f luv = quantized_color(luv_from_linear(light), Gamut::kHdr);
        const Vec3f stored = quantized_hdr(luv);
        CHECK(quantized_color(luv, Gamut::kHdr) == luv);
        CHECK(luv_from_linear(stored) == luv);
        CHECK(stored.minCoeff() >= 0);
        const float size = std::max(light.maxCoeff(), 1.0f / 32);
        CHECK((stored - light).cwiseAbs().maxCoeff() <= 4e-5f * size);
    }
    CHECK(quantized_hdr(luv_from_linear(Vec3f::Zero())) == Vec3f::Zero());
    CHECK(quantized_hdr(luv_from_linear(Vec3f::Constant(1e30f))) == Vec3f::Constant(kMaxHdr));
}

TEST_CASE("light: colours without an upper bound stay, others become light that exists") {
    std::mt19937 random(2);
    for (int n = 0; n < 3000; ++n) {
        const Vec3f luv = luv_from_linear(random_light(random));
        CHECK(in_gamut(luv, Gamut::kHdr) == luv);
        const Vec3f wild(luv[0], 3 * luv[1] + 50, 3 * luv[2] - 50), tamed = in_gamut(wild, Gamut::kHdr);
        const Vec3f linear = linear_from_luv(tamed);
        CHECK(linear.minCoeff() >= -1e-5f * std::max(1.0f, linear.maxCoeff()));
        CHECK(in_gamut(tamed, Gamut::kHdr) == tamed);
    }
}

// Heights around 8000 with a range of 20: the range becomes 80 = 20 x 4, and the offset 8000 is a multiple of
// 32.
TEST_CASE("feature space: values lose their offset, and their range becomes that of L*, without rounding") {
    Image image = make_image(3, 1, 2);
    image.channel_names = {"value", "A"};
    image.data = {8000, 1, 8020, 1, 8007.5f, 1};
    const FeatureSpace space = value_space(image, {});
    CHECK(space.auxiliary == Names{"value"});
    CHECK_FALSE(space.color);
    CHECK(space.unit == 4);
    CHECK(space.offset(0) == 8000);
    CHECK(extract_features(image, space).data == std::vector<float>{0, 80, 30});
    // Values outside of the mask count for nothing.
    Mask mask(image, 1);
    mask[1] = 0;
    CHECK(value_space(image, {}, mask).unit == 8);
    // Any range and any place: features stay small, and come back to the last bit of the largest value.
    std::mt19937 random(5);
    for (const float low : {-1e30f, -32768.0f, 0.0f, 1e-20f, 300.0f, 2e9f})
        for (const float range : {1e-25f, 0.1f, 255.0f, 65535.0f, 4e9f, 1e32f}) {
            INFO(low << " + " << range);
            Image any = make_image(40, 1, 1);
            any.channel_names = {"height"};
            for (float& x : any.data) x = low + range * static_cast<float>(random() % 1000) / 1000;
            const FeatureSpace of = value_space(any, {});
            const FeatureImage features = extract_features(any, of);
            for (std::size_t i = 0; i < any.data.size(); ++i) {
                CHECK(std::abs(features.data[i]) <= 200);
                const float back = features.data[i] / of.weight(0) + of.offset(0);
                CHECK(std::abs(back - any.data[i]) <= std::max(std::abs(low), range) * 2.4e-7f);
            }
        }
    CHECK(value_space(image, {{"value", 10}}).weight(0) == 5);  // 10 x 0.5
    CHECK(value_space(image, {{"value", 10}}).unit == 0.5f);
}

TEST_CASE("feature space: what is clipped is counted") {
    Image image = make_image(2, 2, 3);
    image.sample_type = SampleType::kFloat;
    image.color_space = ColorSpace::kLinear;
    image.data = {0.5f, -0.1f, 0, 0, 0, 1, 1, 1, 1, -1, -1, -1};
    CHECK(count_clipped(image, feature_space(image, {})) == 4);
    Mask mask(image, 1);
    mask[3] = 0;
    CHECK(count_clipped(image, feature_space(image, {}, mask), mask) == 1);
    image.data[0] = 2;  // HDR, which is kept
    CHECK(count_clipped(image, feature_space(image, {}, mask), mask) == 1);
    CHECK(count_clipped(image, value_space(image, {{"R"}})) == 0);
}
