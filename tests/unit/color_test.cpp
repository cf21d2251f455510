#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <utility>

#include "libcore/image/color.h"

using namespace imgmesh;

// Reference values: sRGB primaries in L*u*v* under D65, as tabulated by Lindbloom's calculator.
TEST_CASE("luv: white, black and the primaries have their known values") {
    CHECK((luv_from_linear({1, 1, 1}) - Vec3f(100, 0, 0)).norm() < 1e-3);
    CHECK(luv_from_linear({0, 0, 0}).norm() == 0);
    CHECK((luv_from_linear({1, 0, 0}) - Vec3f(53.24f, 175.01f, 37.76f)).norm() < 0.1);
    CHECK((luv_from_linear({0, 1, 0}) - Vec3f(87.74f, -83.07f, 107.39f)).norm() < 0.1);
    CHECK((luv_from_linear({0, 0, 1}) - Vec3f(32.30f, -9.40f, -130.34f)).norm() < 0.1);
}

TEST_CASE("luv: the inverse gives linear colour back, dark, bright and beyond white") {
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        const float scale = std::pow(10.0f, std::uniform_real_distribution<float>(-4, 1)(random));
        Vec3f linear;
        for (int c = 0; c < 3; ++c) linear[c] = scale * std::uniform_real_distribution<float>(0, 1)(random);
        CHECK((linear_from_luv(luv_from_linear(linear)) - linear).norm() <= 2e-5f * linear.norm() + 1e-9f);
    }
}

TEST_CASE("colour spaces: encode inverts decode, and names parse back") {
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kLinear, ColorSpace::kRec709,
                                   ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3}) {
        CHECK(parse_color_space(color_space_name(space)) == space);
        for (const float x : {-0.2f, 0.0f, 0.001f, 0.03f, 0.0405f, 0.2f, 0.7f, 1.0f, 1.5f}) {
            const Vec3f encoded(x, 0.5f * x, 0.25f);
            const Vec3f back = encoded_from_linear(space, linear_from_encoded(space, encoded));
            CHECK((back - encoded).norm() < 1e-4);
        }
        CHECK((linear_from_encoded(space, {1, 1, 1}) - Vec3f(1, 1, 1)).norm() <
              1e-5);  // white is white everywhere
    }
    CHECK_FALSE(parse_color_space("sRGBx").has_value());
}

// The container's colours must survive any number of reads and writes unchanged.
TEST_CASE("quantized colours: every stored code reads back as itself") {
    std::mt19937 random(2);
    for (int i = 0; i < 5000; ++i) {
        std::array<std::uint16_t, 3> codes;
        for (auto& code : codes) code = static_cast<std::uint16_t>(random() >> (16 + random() % 16));
        CHECK(color_codes(color_from_codes(codes)) == codes);
    }
    CHECK(color_codes(luv_from_linear({2, -0.1f, 0.25f})) == std::array<std::uint16_t, 3>{65535, 0, 16384});
}

TEST_CASE("luv image: the table for 8-bit samples changes no bit") {
    for (const ColorSpace space :
         {ColorSpace::kSrgb, ColorSpace::kRec709, ColorSpace::kGamma22, ColorSpace::kAdobeRgb}) {
        Image image = make_image(256, 3, 3);
        image.color_space = space;
        for (std::size_t i = 0; i < image.data.size(); ++i)
            image.data[i] = static_cast<float>(i * 37 % 256) / 255.0f;
        image.data[5] = 0.1234f;  // no code at all
        image.data[6] = -0.25f;
        Image plain = image;
        plain.sample_type = SampleType::kFloat;
        CHECK(luv_image(image).data == luv_image(plain).data);
    }
}

TEST_CASE("luv image: rows in single precision are luv_from_linear() of each pixel") {
    std::mt19937 random(3);
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kLinear, ColorSpace::kRec709,
                                   ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3})
        for (const auto& [range, most] :
             {std::pair(Range::kClipped, 1.0f), std::pair(Range::kHdr, kMaxHdr)}) {
            Image image = make_image(117, 5, 4);  // rows end amid eight lanes; alpha is between them
            image.color_space = space;
            for (float& x : image.data) {
                const float power =
                    std::uniform_real_distribution<float>(-5, range == Range::kHdr ? 2 : 0)(random);
                x = random() % 8 ? std::pow(10.0f, power)
                                 : std::uniform_real_distribution<float>(-0.2f, 1.2f)(random);
            }
            image.data[0] = image.data[1] = image.data[2] = 0;
            image.data[4] = image.data[5] = image.data[6] = 0.37f;
            const FeatureImage luv = luv_image(image, range);
            CHECK(luv.pixel(0)[0] == 0);
            for (int c = 1; c < 3; ++c) CHECK((luv.pixel(0)[c] == 0 && luv.pixel(1)[c] == 0));
            for (std::size_t i = 0; i < image.pixel_count(); ++i) {
                const Vec3f linear = linear_from_encoded(space, Vec3f(image.pixel(i)));
                const Vec3f expected = luv_from_linear(linear.cwiseMax(0.0f).cwiseMin(most));
                const float scale = std::max(1.0f, expected.norm() / 100);
                CHECK((Vec3f(luv.pixel(i)) - expected).cwiseAbs().maxCoeff() <= 1e-4f * scale);
            }
        }
}
