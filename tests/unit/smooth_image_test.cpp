// Smoothing: laws that hold for any image, and the fast window against a slow clear one.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/segment/segment.h"
#include "libcore/segment/smooth_image.h"
#include "libcore/segment/smoothing_window.h"
#include "tests/support/segment_maps.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// Cells of side x side pixels.
Level squares(int width, int height, int side) {
    PixelMap map{width, height, {}, WeightPrecision::kFloat};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            map.values.push_back({as_id(as_index((y / side) * width + x / side)), 1.0f / 3, 1.0f / 3});
    return level_of(std::move(map));
}

template <typename Function>
Image image_of(int width, int height, const Function& value) {
    Image image = make_image(width, height, 3);
    image.sample_type = SampleType::kFloat;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const Vec3f color = value(x, y);
            std::copy(color.data(), color.data() + 3, image.pixel(x, y));
        }
    return image;
}

Vec3f grey(double value) {
    return Vec3f::Constant(static_cast<float>(value));
}

Image smoothed(const Level& level, const Image& image, double strength) {
    const Range range = image.color_space == ColorSpace::kLinear ? Range::kHdr : Range::kClipped;
    return smooth_image(level, luv_image(image, range), image, strength);
}

double largest_difference(const Image& a, const Image& b) {
    REQUIRE(a.data.size() == b.data.size());
    double largest = 0;
    for (std::size_t i = 0; i < a.data.size(); ++i)
        largest = std::max(largest, std::abs(double(a.data[i]) - double(b.data[i])));
    return largest;
}

// The standard deviation of G from `mean` in some columns.
double deviation(const Image& image, int left, int right, double mean) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
        for (int x = left; x < right; ++x) sum += std::pow(double(image.pixel(x, y)[1]) - mean, 2);
    return std::sqrt(sum / (image.height * (right - left)));
}

}  // namespace

TEST_CASE("smoothing: a constant stays, at any strength") {
    const Image image = image_of(21, 17, [](int, int) { return Vec3f(0.3f, 0.7f, 0.1f); });
    for (const double strength : {0.0, 0.5, 8.0, 1000.0})
        CHECK(largest_difference(smoothed(squares(21, 17, 5), image, strength), image) < 1e-6);
}

TEST_CASE("smoothing: strength 0 is the image, and a little strength nearly") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(0, 1);
    const Image image =
        image_of(20, 16, [&](int, int) { return Vec3f(float(any(random)), float(any(random)), 0.5f); });
    CHECK(largest_difference(smoothed(squares(20, 16, 4), image, 0), image) < 1e-6);
    CHECK(largest_difference(smoothed(squares(20, 16, 4), image, 0.001), image) < 1e-3);
}

// 60 is more than three times the strength, so no weight is left across it.
TEST_CASE("smoothing: a strong step keeps every pixel, and has no halo with noise either") {
    const auto step = [](int x, int) { return grey(x < 15 ? 0.2 : 0.8); };
    const Level level = squares(30, 24, 5);
    const Image clean = image_of(30, 24, step);
    CHECK(largest_difference(smoothed(level, clean, 15), clean) < 1e-6);

    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.03);
    const Image noisy =
        image_of(30, 24, [&](int x, int y) { return Vec3f(step(x, y) + grey(noise(random))); });
    const Image result = smoothed(level, noisy, 15);
    for (int x = 0; x < 30; ++x) {
        CAPTURE(x);
        CHECK(deviation(result, x, x + 1, x < 15 ? 0.2 : 0.8) < 0.015);
    }
}

// Differences inside the window are far below the strength. Means of pixels on one side would bend the ends.
TEST_CASE("smoothing: a ramp stays a ramp up to the borders, without stairs at the cells") {
    const Image ramp = image_of(40, 30, [](int x, int y) { return grey(0.1 + 0.012 * x + 0.006 * y); });
    CHECK(largest_difference(smoothed(squares(40, 30, 6), ramp, 30), ramp) < 3e-4);
    // With a strong border in the middle.
    const Image two = image_of(40, 30, [](int x, int) { return grey(0.1 + 0.005 * x + (x < 20 ? 0 : 0.6)); });
    CHECK(largest_difference(smoothed(squares(40, 30, 5), two, 15), two) < 3e-4);
}

TEST_CASE("smoothing: noise falls inside regions, the more the stronger") {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 0.04);
    const Image noisy = image_of(48, 40, [&](int, int) {
        return Vec3f(float(0.5 + noise(random)), float(0.5 + noise(random)), float(0.5 + noise(random)));
    });
    double last = deviation(noisy, 0, 48, 0.5);
    for (const double strength : {2.0, 5.0, 10.0, 20.0}) {
        const double now = deviation(smoothed(squares(48, 40, 8), noisy, strength), 0, 48, 0.5);
        CHECK(now < last);
        last = now;
    }
    CHECK(last < 0.008);
}

// What is outside is red or blue: it makes no difference anywhere, as nobody is to see what was cut off.
TEST_CASE("smoothing: pixels outside the mask give no colour and have none") {
    Level level = squares(24, 20, 6);
    const auto outside = [](int x, int y) {
        return (x - 12) * (x - 12) + (y - 10) * (y - 10) < 30 || x == 0;
    };
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x)
            if (outside(x, y)) level.map.at(x, y) = {};
    const auto with = [&](const Vec3f& other) {
        return image_of(24, 20, [&](int x, int y) {
            return outside(x, y) ? other : grey(0.5 + 0.02 * ((x * 7 + y * 3) % 5));
        });
    };
    const Image red = smoothed(level, with({1, 0, 0}), 12), blue = smoothed(level, with({0, 0, 1}), 12);
    REQUIRE(red.channels == 4);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            const float *a = red.pixel(x, y), *b = blue.pixel(x, y);
            CHECK(a[3] == (outside(x, y) ? 0.0f : 1.0f));
            CHECK((a[0] == b[0] && a[1] == b[1] && a[2] == b[2]));
            if (outside(x, y)) CHECK((a[0] == 0 && a[1] == 0 && a[2] == 0));
        }
}

TEST_CASE("smoothing: clear pixels give next to no colour, alpha stays") {
    Image image = make_image(20, 12, 4);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 20; ++x) {
            const bool clear = x >= 10;
            const float values[4] = {clear ? 0.6f : 0.5f, clear ? 0.6f : 0.5f, 0.5f, clear ? 0.0f : 0.75f};
            std::copy(values, values + 4, image.pixel(x, y));
        }
    const Image result = smoothed(squares(20, 12, 20), image, 60);
    for (int y = 0; y < 12; ++y)
        for (int x = 0; x < 20; ++x) {
            CHECK(result.pixel(x, y)[3] == image.pixel(x, y)[3]);
            if (x < 10) CHECK(result.pixel(x, y)[0] == doctest::Approx(0.5).epsilon(0.004));
        }
}

// 1 and 1000 are black and white there; noise of a tenth falls on both sides.
TEST_CASE("smoothing: HDR keeps its range") {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> noise(0.9, 1.1);
    Image image = image_of(30, 30, [&](int x, int) { return grey((x < 15 ? 1 : 1000) * noise(random)); });
    image.color_space = ColorSpace::kLinear;
    const Image result = smoothed(squares(30, 30, 5), image, 100);
    CHECK(result.color_space == ColorSpace::kLinear);
    CHECK(deviation(result, 15, 30, 1000) < deviation(image, 15, 30, 1000) / 3);
    CHECK(deviation(result, 0, 15, 1) < deviation(image, 0, 15, 1) / 3);
}

TEST_CASE("smoothing: grey gives RGB; one pixel, one row and one column") {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(13, 1), std::pair(1, 13)}) {
        Image image = make_image(width, height, 1);
        for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = 0.3f + 0.01f * float(i);
        const Image result = smoothed(squares(width, height, 4), image, 30);
        REQUIRE(result.channels == 3);
        for (std::size_t i = 0; i < image.data.size(); ++i)
            for (int c = 0; c < 3; ++c)
                CHECK(result.pixel(i)[c] == doctest::Approx(image.data[i]).epsilon(1e-3));
    }
}

TEST_CASE("smoothing: the same bytes for any number of threads") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> any(0.3, 0.7);
    const Image image = image_of(50, 45, [&](int, int) { return grey(any(random)); });
    const Level level = squares(50, 45, 7);
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return smoothed(level, image, 10).data;
    };
    CHECK(with(1) == with(4));
}

TEST_CASE("smoothing: what it refuses") {
    const Image image = image_of(4, 4, [](int, int) { return grey(0.5); });
    for (const double strength : {-1.0, 2000.0, std::nan("")})
        CHECK_THROWS_AS(smoothed(squares(4, 4, 2), image, strength), Error);
    CHECK_THROWS_AS(smoothed(squares(5, 4, 2), image, 8), Error);
    Image data = make_image(4, 4, 1);
    data.channel_names = {"depth"};
    CHECK_THROWS_AS(smooth_image(squares(4, 4, 2), luv_image(image), data, 8), Error);
}

// Merges 0-1 at 2, 2-3 at 3, then both at 5; 4 is an island.
TEST_CASE("merge heights: by hand") {
    const Hierarchy hierarchy{5, {{0, 1, 2}, {2, 3, 3}, {0, 2, 5}}};
    const MergeHeights heights(hierarchy, 0);
    const auto between = [&](std::size_t a, std::size_t b) {
        return heights.between(heights.places()[a], heights.places()[b]);
    };
    CHECK(between(0, 0) == 0);
    CHECK(between(0, 1) == 2);
    CHECK(between(3, 2) == 3);
    CHECK(between(1, 3) == 5);
    CHECK(std::isinf(between(4, 1)));
    const MergeHeights coarse(hierarchy, 2.5f);
    CHECK(coarse.places()[0] == coarse.places()[1]);
    CHECK(coarse.places()[2] != coarse.places()[3]);
}

// Two cells merge at the height of the first merge after which their regions are one.
TEST_CASE("merge heights: those of many random merges") {
    std::mt19937 random(11);
    Hierarchy hierarchy{200, {}};
    for (std::size_t k = 0; k < 197; ++k) {
        const std::vector<Id> region = regions_after(hierarchy, k);
        Id a = 0, b = 0;
        while (region[a] == region[b]) {
            a = as_id(random() % 200);
            b = as_id(random() % 200);
        }
        // By their first cells, as segment() has them.
        const auto first = [&](Id cell) {
            return as_id(as_index(std::ranges::find(region, region[cell]) - region.begin()));
        };
        const Id i = std::min(first(a), first(b)), j = std::max(first(a), first(b));
        hierarchy.merges.push_back({i, j, 1 + 0.25f * float(k)});
    }
    const MergeHeights heights(hierarchy, 0);
    for (std::size_t k = 0; k <= 197; k += 7) {
        const std::vector<Id> region = regions_after(hierarchy, k);
        for (int i = 0; i < 500; ++i) {
            const Id a = as_id(random() % 200), b = as_id(random() % 200);
            const bool one = region[a] == region[b];
            CHECK((heights.between(heights.places()[a], heights.places()[b]) < 1 + 0.25f * float(k)) == one);
        }
    }
}

// Written again from the comments of smoothing_window.h, in double precision. A contour of height 9 and 4
// lies between three cells of nearly the same colours.
TEST_CASE("smoothing window: as a slow clear one, with heights, shares and borders") {
    constexpr int kWidth = 37, kHeight = 26;
    const GridSize size{kWidth, kHeight};
    std::mt19937 random(13);
    std::uniform_real_distribution<float> any(40, 50);
    const MergeHeights heights({3, {{0, 1, 4}, {0, 2, 9}}}, 0);
    PaddedPlanes values(size, 4), guide(size, 3);
    std::vector<std::int32_t> places(values.stride() * (kHeight + 2 * PaddedPlanes::kMargin), -1);
    const auto cell = [](int x, int y) { return static_cast<std::size_t>(x < 12 ? 0 : y < 13 ? 1 : 2); };
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            const std::size_t i = values.index(x, y);
            for (int c = 0; c < 3; ++c) {
                values.plane(c)[i] = any(random);
                guide.plane(c)[i] = any(random);
            }
            values.plane(3)[i] = random() % 5 == 0 ? 0 : 0.5f + 0.1f * float(random() % 5);
            places[i] = static_cast<std::int32_t>(heights.places()[cell(x, y)]);
        }
    const SmoothingScene scene{size, values, places, heights};
    const SmoothingWeights weights{9, 5, 2.5};
    const double height[3][3] = {{0, 4, 9}, {4, 0, 9}, {9, 9, 0}};
    for (const bool straight : {false, true}) {
        const PaddedPlanes fast = smooth_planes(scene, guide, weights, straight);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x) {
                const std::size_t i = values.index(x, y);
                if (!(values.plane(3)[i] > 0)) {
                    CHECK(fast.plane(0)[i] == values.plane(0)[i]);
                    continue;
                }
                // Least squares for value = a + b dx + c dy, with a little that holds the slopes down.
                Eigen::Matrix3d left = Eigen::Matrix3d::Zero();
                Eigen::Vector3d right = Eigen::Vector3d::Zero();
                for (int v = std::max(0, y - 5); v <= std::min(kHeight - 1, y + 5); ++v)
                    for (int u = std::max(0, x - 5); u <= std::min(kWidth - 1, x + 5); ++u) {
                        const int square = (u - x) * (u - x) + (v - y) * (v - y);
                        if (square > 25) continue;
                        const std::size_t j = values.index(u, v);
                        double t = std::pow(height[cell(x, y)][cell(u, v)] / weights.height, 2);
                        for (int c = 0; c < 3; ++c)
                            t += std::pow(
                                (double(guide.plane(c)[i]) - double(guide.plane(c)[j])) / weights.range, 2);
                        const double weight = std::pow(std::max(0.0, 1 - t / 8), 8) *
                                              std::exp(-square / (2 * weights.spatial * weights.spatial)) *
                                              double(values.plane(3)[j]);
                        const Eigen::Vector3d at(1, u - x, v - y);
                        left += weight * at * at.transpose();
                        right += weight * at * double(values.plane(0)[j]);
                    }
                const Eigen::Vector3d mean = left.col(0) / left(0, 0);
                Eigen::Matrix2d spread = left.bottomRightCorner<2, 2>() / left(0, 0);
                spread -= mean.tail<2>() * mean.tail<2>().transpose();
                spread += 1e-3 * Eigen::Matrix2d::Identity();
                const double value = right(0) / left(0, 0);
                const Eigen::Vector2d slope =
                    spread.inverse() * (right.tail<2>() / left(0, 0) - value * mean.tail<2>());
                const double expected = straight ? value - slope.dot(mean.tail<2>()) : value;
                CHECK(double(fast.plane(0)[i]) == doctest::Approx(expected).epsilon(1e-4));
            }
    }
}
