#include <doctest/doctest.h>

#include <random>

#include "libcore/image/color.h"

using namespace imgmesh;

namespace {

// A little over half a 16-bit code: differences that the container's rounding removes.
constexpr float kSlack = 8e-6f;

bool is_in_gamut(const Vec3f& luv) {
    const Vec3f linear = linear_from_luv(luv);
    return linear.minCoeff() >= -kSlack && linear.maxCoeff() <= 1 + kSlack;
}

Vec3f clamped(const Vec3f& luv) {
    return luv_from_linear(linear_from_luv(luv).cwiseMax(0.0f).cwiseMin(1.0f));
}

// L*u*v* colours all over and far beyond the gamut, many of them dark: there it is narrowest.
std::vector<Vec3f> colors() {
    std::mt19937 random(1);
    const auto uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    std::vector<Vec3f> out{{0, 0, 0},   {100, 0, 0}, {0, 50, 50},   {-3, 20, -30},
                           {-20, 0, 0}, {130, 5, 5}, {1e-4f, 30, 0}};
    for (int n = 0; n < 3000; ++n)
        out.emplace_back(n % 3 == 0 ? uniform(-5, 10) : uniform(-20, 130), uniform(-200, 250),
                         uniform(-200, 200));
    return out;
}

}  // namespace

TEST_CASE("in_gamut: the result is in gamut, and a colour that exists") {
    for (const Vec3f& luv : colors()) {
        INFO("L*u*v* " << luv.transpose());
        const Vec3f result = in_gamut(luv);
        CHECK(is_in_gamut(result));
        // Black has no chroma: (0, u, v) is no real colour.
        CHECK((luv_from_linear(linear_from_luv(result)) - result).norm() < 1e-2f);
    }
}

TEST_CASE("in_gamut: colours of the gamut stay as they are, a second time as well") {
    std::mt19937 random(2);
    for (int n = 0; n < 3000; ++n) {
        Vec3f linear;
        for (int c = 0; c < 3; ++c) linear[c] = std::uniform_real_distribution<float>(0, 1)(random);
        if (n % 2) linear *= std::pow(10.0f, -static_cast<float>(random() % 50) / 10);
        const Vec3f luv = luv_from_linear(linear);
        CHECK(in_gamut(luv) == luv);
    }
    for (const Vec3f& luv : colors()) CHECK(in_gamut(in_gamut(luv)) == in_gamut(luv));
}

TEST_CASE("in_gamut: never further away than clamped channels") {
    for (const Vec3f& luv : colors()) {
        INFO("L*u*v* " << luv.transpose());
        CHECK((in_gamut(luv) - luv).norm() <= (clamped(luv) - luv).norm() * (1 + 1e-6f));
    }
}

// Where a fit of colours overshoots: dark, and slightly outside.
TEST_CASE("in_gamut: much closer than clamped channels where colours are dark") {
    std::mt19937 random(3);
    const auto uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    double sum = 0, sum_clamped = 0;
    for (int n = 0; n < 1000; ++n) {
        Vec3f luv = luv_from_linear(0.01f * Vec3f(uniform(0, 1), uniform(0, 1), uniform(0, 1)));
        luv += Vec3f(uniform(-2, 2), uniform(-4, 4), uniform(-4, 4));
        sum += double((in_gamut(luv) - luv).norm());
        sum_clamped += double((clamped(luv) - luv).norm());
    }
    CHECK(sum < 0.7 * sum_clamped);
}

TEST_CASE("quantized colours: storing twice is storing once, from anywhere") {
    for (const Vec3f& luv : colors()) {
        const Vec3f once = quantized_color(luv);
        INFO("L*u*v* " << luv.transpose());
        CHECK(quantized_color(once) == once);
        CHECK(color_codes(once) == color_codes(luv));
        // Only rounding to 16 bits separates it from the colour in gamut.
        CHECK((linear_from_luv(once) - linear_from_luv(in_gamut(luv))).cwiseAbs().maxCoeff() < 1.2e-5f);
    }
}
