#include "libcore/metrics/compare_images.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/metrics/ciede2000.h"
#include "libcore/metrics/error_image.h"
#include "libcore/metrics/ssim.h"

using namespace imgmesh;
using doctest::Approx;

namespace {

Image random_image(int width, int height, int channels, std::uint32_t seed) {
    std::mt19937 random(seed);
    Image image = make_image(width, height, channels);
    for (float& x : image.data) x = static_cast<float>(random() % 1001) / 1000;
    return image;
}

}  // namespace

TEST_CASE("compare_images: hand-made differences") {
    Image a = make_image(2, 1, 3), b = a;
    CHECK(compare_images(a, b).rms_rgb == 0);
    CHECK(std::isinf(compare_images(a, b).psnr));
    for (float& x : b.data) x = 1;
    ImageDifference d = compare_images(a, b);
    CHECK(d.rms_rgb == Approx(1));
    CHECK(d.psnr == Approx(0));
    CHECK(d.max_rgb == Approx(1));
    CHECK(d.rms_luv == Approx(100));  // black and white are 100 apart in L*

    b = a;
    b.pixel(1, 0)[2] = 0.6f;  // one sample of six
    d = compare_images(a, b);
    CHECK(d.rms_rgb == Approx(0.6 / std::sqrt(6.0)));
    CHECK(d.psnr == Approx(20 * std::log10(std::sqrt(6.0) / 0.6)));
    CHECK(d.max_rgb == Approx(0.6));

    Image grey = make_image(2, 1, 2);  // colours do not depend on alpha
    grey.pixel(0, 0)[1] = 1;
    CHECK(compare_images(a, grey).rms_rgb == 0);
    CHECK_THROWS_AS(compare_images(a, make_image(1, 2, 3)), Error);
}

TEST_CASE("compare_images: one pixel that is known in every figure") {
    const Image a = make_image(1, 1, 3);
    Image b = a;
    b.data = {1, 1, 1};
    const ImageDifference d = compare_images(a, b);
    CHECK(d.pixels == 1);
    CHECK(d.max_luv == Approx(100));
    CHECK(d.luv[0] == Approx(100));
    CHECK(d.ciede2000[0] == Approx(100));  // S_L is 1 at the mean lightness of 50
    CHECK(std::isnan(d.ssim));             // no window fits
}

TEST_CASE("compare_images: symmetric, and the same for any number of threads") {
    const Image a = random_image(70, 50, 3, 1), b = random_image(70, 50, 3, 2);
    const ImageDifference d = compare_images(a, b), swapped = compare_images(b, a);
    CHECK(d.rms_luv == swapped.rms_luv);
    CHECK(d.ssim == swapped.ssim);
    for (std::size_t i = 0; i < d.ciede2000.size(); ++i)
        CHECK(d.ciede2000[i] == Approx(swapped.ciede2000[i]));
    const ThreadLimit one(1);
    const ImageDifference alone = compare_images(a, b);
    CHECK(alone.rms_luv == d.rms_luv);
    CHECK(alone.rms_rgb == d.rms_rgb);
    CHECK(alone.ssim == d.ssim);
}

// The same light in two encodings is no difference; linear RGB is compared as sRGB.
TEST_CASE("compare_images: images of different colour spaces") {
    const Image srgb = random_image(20, 20, 3, 3);
    for (const ColorSpace space : {ColorSpace::kLinear, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3}) {
        Image other = srgb;
        other.color_space = space;
        for (std::size_t i = 0; i < other.data.size(); i += 3) {
            Eigen::Map<Vec3f> p(other.data.data() + i);
            p = encoded_from_linear(space, linear_from_encoded(ColorSpace::kSrgb, p));
        }
        const ImageDifference d = compare_images(srgb, other);
        CHECK(d.color_space == ColorSpace::kSrgb);
        CHECK(d.rms_rgb < 1e-6);
        CHECK(d.max_luv < 1e-3);
        CHECK(d.ssim == Approx(1));
        CHECK(compare_images(other, other).color_space ==
              (space == ColorSpace::kLinear ? ColorSpace::kSrgb : space));
    }
}

TEST_CASE("compare_images: wholly transparent pixels do not count, others do") {
    Image a = random_image(4, 3, 4, 4), b = a;
    for (std::size_t i = 3; i < a.data.size(); i += 4) a.data[i] = b.data[i] = 1;
    a.pixel(0, 0)[3] = b.pixel(0, 0)[3] = 0;
    a.pixel(1, 0)[3] = 0;
    b.pixel(2, 0)[3] = 0.01f;
    for (int x = 0; x < 3; ++x) b.pixel(x, 0)[1] = a.pixel(x, 0)[1] + 0.5f;
    const ImageDifference d = compare_images(a, b);
    CHECK(d.pixels == 10);
    CHECK(d.in_one_only == 1);
    CHECK(d.max_rgb == Approx(0.5));
    CHECK(d.rms_rgb == Approx(0.5 / std::sqrt(30.0)));
    CHECK(std::isnan(d.luv[0]));
    CHECK(std::isnan(d.ciede2000[1]));
    CHECK(d.luv[2] > 0);
    CHECK(d.luv[3] == 0);
}

// White at alpha 1/2 over black is the encoded grey 1/2, over white it is white: the black ground counts.
TEST_CASE("compare_images: alpha counts by what one sees over black or white") {
    Image a = make_image(2, 1, 4), b;
    a.data = {1, 1, 1, 1, 1, 1, 1, 1};
    b = a;
    b.pixel(1, 0)[3] = 0.5f;
    const double grey = luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, Vec3f(0.5f, 0.5f, 0.5f)))[0];
    ImageDifference d = compare_images(a, b);
    CHECK(d.rms_luv == 0);
    CHECK(d.max_visible == Approx(100 - grey));
    CHECK(d.rms_visible == Approx((100 - grey) / std::sqrt(2.0)));
    CHECK(d.max_alpha == Approx(0.5));
    CHECK(d.rms_alpha == Approx(0.5 / std::sqrt(2.0)));
    CHECK(compare_images(b, a).rms_visible == d.rms_visible);
    CHECK(compare_images(make_image(2, 1, 3), a).max_alpha == 0);  // no alpha is opaque

    for (int c = 0; c < 3; ++c) a.pixel(1, 0)[c] = b.pixel(1, 0)[c] = 0;  // black shows over white
    d = compare_images(a, b);
    CHECK(d.max_visible == Approx(grey));
    b.pixel(1, 0)[3] = 254.0f / 255;  // one step
    CHECK(compare_images(a, b).rms_visible > 0);

    // A colour that nobody sees is none; a pixel in one only differs by all of what is seen.
    a.pixel(1, 0)[3] = b.pixel(1, 0)[3] = 0;
    b.pixel(1, 0)[0] = 1;
    d = compare_images(a, b);
    CHECK(d.rms_visible == 0);
    CHECK(d.visible[0] == 0);
    CHECK(std::isnan(d.visible[1]));
    b.pixel(0, 0)[3] = 0;
    d = compare_images(a, b);
    CHECK(d.pixels == 0);
    CHECK(std::isnan(d.rms_luv));
    CHECK(d.max_visible == Approx(100));
    CHECK(d.rms_visible == Approx(100));  // of the one pixel that is seen at all
}

TEST_CASE("compare_images: opaque pixels are seen as they are") {
    const Image a = random_image(9, 7, 3, 7), b = random_image(9, 7, 3, 8);
    const ImageDifference d = compare_images(a, b);
    CHECK(d.rms_visible == d.rms_luv);
    CHECK(d.max_visible == d.max_luv);
    CHECK(d.visible == d.luv);
}

TEST_CASE("compare_images: an image without colour is refused") {
    const Image five = make_image(2, 2, 5);
    CHECK_FALSE(has_color(five));
    CHECK(has_color(make_image(2, 2, 1)));
    CHECK(has_color(make_image(2, 2, 4)));
    CHECK_THROWS_AS(compare_images(five, make_image(2, 2, 3)), Error);
    CHECK_THROWS_AS(compare_images(make_image(2, 2, 3), five), Error);
}

TEST_CASE("lab_from_linear: white, grey and the sRGB primaries") {
    CHECK((lab_from_linear({1, 1, 1}) - Vec3d(100, 0, 0)).norm() < 1e-4);
    CHECK((lab_from_linear({0, 0, 0}) - Vec3d(0, 0, 0)).norm() < 1e-9);
    // Y = 0.18: L* = 116 cbrt(0.18) - 16
    CHECK((lab_from_linear({0.18f, 0.18f, 0.18f}) - Vec3d(49.496, 0, 0)).norm() < 1e-3);
    // Widely published values, rounded to two digits there.
    CHECK((lab_from_linear({1, 0, 0}) - Vec3d(53.24, 80.09, 67.20)).norm() < 0.03);
    CHECK((lab_from_linear({0, 1, 0}) - Vec3d(87.73, -86.18, 83.18)).norm() < 0.03);
    CHECK((lab_from_linear({0, 0, 1}) - Vec3d(32.30, 79.19, -107.86)).norm() < 0.03);
}

// Table 1 of Sharma, Wu, Dalal 2005: all 34 pairs, which cover every branch of the formula.
TEST_CASE("ciede2000: the published test pairs") {
    struct Pair {
        Vec3d a, b;
        double difference;
    };
    const Pair pairs[] = {
        {{50.0000, 2.6772, -79.7751}, {50.0000, 0.0000, -82.7485}, 2.0425},
        {{50.0000, 3.1571, -77.2803}, {50.0000, 0.0000, -82.7485}, 2.8615},
        {{50.0000, 2.8361, -74.0200}, {50.0000, 0.0000, -82.7485}, 3.4412},
        {{50.0000, -1.3802, -84.2814}, {50.0000, 0.0000, -82.7485}, 1.0000},
        {{50.0000, -1.1848, -84.8006}, {50.0000, 0.0000, -82.7485}, 1.0000},
        {{50.0000, -0.9009, -85.5211}, {50.0000, 0.0000, -82.7485}, 1.0000},
        {{50.0000, 0.0000, 0.0000}, {50.0000, -1.0000, 2.0000}, 2.3669},
        {{50.0000, -1.0000, 2.0000}, {50.0000, 0.0000, 0.0000}, 2.3669},
        {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0009}, 7.1792},
        {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0010}, 7.1792},
        {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0011}, 7.2195},
        {{50.0000, 2.4900, -0.0010}, {50.0000, -2.4900, 0.0012}, 7.2195},
        {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0009, -2.4900}, 4.8045},
        {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0010, -2.4900}, 4.8045},
        {{50.0000, -0.0010, 2.4900}, {50.0000, 0.0011, -2.4900}, 4.7461},
        {{50.0000, 2.5000, 0.0000}, {50.0000, 0.0000, -2.5000}, 4.3065},
        {{50.0000, 2.5000, 0.0000}, {73.0000, 25.0000, -18.0000}, 27.1492},
        {{50.0000, 2.5000, 0.0000}, {61.0000, -5.0000, 29.0000}, 22.8977},
        {{50.0000, 2.5000, 0.0000}, {56.0000, -27.0000, -3.0000}, 31.9030},
        {{50.0000, 2.5000, 0.0000}, {58.0000, 24.0000, 15.0000}, 19.4535},
        {{50.0000, 2.5000, 0.0000}, {50.0000, 3.1736, 0.5854}, 1.0000},
        {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2972, 0.0000}, 1.0000},
        {{50.0000, 2.5000, 0.0000}, {50.0000, 1.8634, 0.5757}, 1.0000},
        {{50.0000, 2.5000, 0.0000}, {50.0000, 3.2592, 0.3350}, 1.0000},
        {{60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}, 1.2644},
        {{63.0109, -31.0961, -5.8663}, {62.8187, -29.7946, -4.0864}, 1.2630},
        {{61.2901, 3.7196, -5.3901}, {61.4292, 2.2480, -4.9620}, 1.8731},
        {{35.0831, -44.1164, 3.7933}, {35.0232, -40.0716, 1.5901}, 1.8645},
        {{22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}, 2.0373},
        {{36.4612, 47.8580, 18.3852}, {36.2715, 50.5065, 21.2231}, 1.4146},
        {{90.8027, -2.0831, 1.4410}, {91.1528, -1.6435, 0.0447}, 1.4441},
        {{90.9257, -0.5406, -0.9208}, {88.6381, -0.8985, -0.7239}, 1.5381},
        {{6.7747, -0.2908, -2.4247}, {5.8714, -0.0985, -2.2286}, 0.6377},
        {{2.0776, 0.0795, -1.1350}, {0.9033, -0.0636, -0.5514}, 0.9082},
    };
    for (const Pair& pair : pairs) {
        CAPTURE(pair.a.transpose());
        CAPTURE(pair.b.transpose());
        CHECK(std::abs(ciede2000(pair.a, pair.b) - pair.difference) < 0.5001e-4);
        CHECK(ciede2000(pair.b, pair.a) == Approx(ciede2000(pair.a, pair.b)));
        CHECK(ciede2000(pair.a, pair.a) == 0);
    }
}

// Constant images have no variance, so only the luminance term is left: (2 p q + C1) / (p^2 + q^2 + C1).
TEST_CASE("mean_ssim: constant images") {
    const std::vector<float> p(20 * 15, 0.25f), q(20 * 15, 0.75f);
    CHECK(mean_ssim(p, p, 20, 15) == Approx(1));
    CHECK(mean_ssim(p, q, 20, 15) == Approx((0.375 + 1e-4) / (0.625 + 1e-4)));
}

// One window of 11 x 11 with one sample changed in its middle: moments follow from the middle's weight w.
TEST_CASE("mean_ssim: one impulse in one window") {
    double sum = 0;
    for (int i = -5; i <= 5; ++i) sum += std::exp(-i * i / 4.5);
    const double w = 1 / (sum * sum);
    std::vector<float> a(121, 0.0f), b = a;
    b[60] = 1;
    // Means 0 and w, variances 0 and w - w^2, covariance 0.
    const double expected = 1e-4 / (w * w + 1e-4) * 9e-4 / (w - w * w + 9e-4);
    CHECK(mean_ssim(a, b, 11, 11) == Approx(expected));
    CHECK(mean_ssim(b, b, 11, 11) == Approx(1));
}

TEST_CASE("mean_ssim: inverted contrast is below zero, no window is NaN, NaN leaves windows out") {
    std::vector<float> a, b;
    for (int i = 0; i < 13 * 11; ++i) {
        a.push_back(i % 2 == 0 ? 0.2f : 0.8f);
        b.push_back(i % 2 == 0 ? 0.8f : 0.2f);
    }
    CHECK(mean_ssim(a, b, 13, 11) < -0.9);
    CHECK(std::isnan(mean_ssim({a.data(), 110}, {b.data(), 110}, 10, 11)));
    CHECK(std::isnan(mean_ssim({a.data(), 110}, {b.data(), 110}, 11, 10)));
    // Column 0 is only in the first of the three windows; differences there no longer count.
    b = a;
    b[0] = 1;
    CHECK(mean_ssim(a, b, 13, 11) < 1);
    b[0] = std::numeric_limits<float>::quiet_NaN();
    CHECK(mean_ssim(a, b, 13, 11) == Approx(1));
    b[6] = b[0];  // a column of all three
    CHECK(std::isnan(mean_ssim(a, b, 13, 11)));
}

TEST_CASE("error_color: as light as the error is large, and inside sRGB") {
    for (int i = 0; i <= 100; ++i) {
        const Vec3f luv = error_color(i / 100.0);
        CAPTURE(i);
        CHECK(luv[0] == Approx(i).epsilon(1e-5));
        const Vec3f linear = linear_from_luv(luv);
        CHECK(linear.minCoeff() > -0.003);
        CHECK(linear.maxCoeff() < 1.003);
    }
    CHECK(error_color(-1) == error_color(0));
    CHECK(error_color(7) == error_color(1));
}

TEST_CASE("error_image: the ends of the scale, its middle, and no value") {
    const std::vector<float> error = {0, 5, 20, std::numeric_limits<float>::quiet_NaN()};
    const Image image = error_image(error, 2, 2, 10);
    CHECK(image.width == 2);
    CHECK(image.channels == 3);
    const auto at = [&](int x, int y) { return Eigen::Map<const Vec3f>(image.pixel(x, y)); };
    CHECK(at(0, 0).norm() < 1e-5);
    CHECK((at(1, 0) - encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(error_color(0.5)))).norm() <
          0.02);
    CHECK((at(0, 1) - Vec3f(1, 1, 1)).norm() < 1e-3);
    CHECK(at(1, 1)[1] > at(1, 1)[0]);  // green
    CHECK(at(1, 1)[1] > at(1, 1)[2]);
}
