// The second stage of segmentation: what can be computed by hand, and slow versions of what is fast.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "libcore/base/parallel.h"
#include "libcore/segment/contour_hierarchy.h"
#include "libcore/segment/contours/contour_contrasts.h"
#include "libcore/segment/contours/half_discs.h"
#include "libcore/segment/contours/majority.h"
#include "tests/support/segment_maps.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr double kPi = std::numbers::pi;

// An image whose lightness is a function of x and y.
template <typename F>
FeatureImage grey(int width, int height, const F& lightness) {
    FeatureImage image{width, height, 3, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (const float value : {float(lightness(x, y)), 0.0f, 0.0f}) image.data.push_back(value);
    return image;
}

LabelImage halves(int width, int height) {
    LabelImage labels(Grid<Id>(GridSize{width, height}, 0), 2);
    for (int y = 0; y < height; ++y)
        for (int x = width / 2; x < width; ++x) labels.at(x, y) = 1;
    return labels;
}

Grid<Id> all_inside(int width, int height) {
    return Grid<Id>(GridSize{width, height}, 0);
}

}  // namespace

TEST_CASE("images are measured at the size of BSDS500's") {
    CHECK(measuring_factor({1, 1}) == 1);
    CHECK(measuring_factor({481, 321}) == 1);
    CHECK(measuring_factor({962, 642}) == 2);
    CHECK(measuring_factor({4810, 3210}) == 10);
}

// Blocks of 2x2: one whole, one with a pixel inside, one wholly outside, one cut by the frame.
TEST_CASE("a smaller image: means of the pixels inside, and their colours outside") {
    Grid<Id> regions(GridSize{5, 2}, 0);
    for (const int x : {2, 3})
        for (const int y : {0, 1}) regions.at(x, y) = kNone;
    regions.at(2, 1) = 0;
    const FeatureImage image = grey(5, 2, [](int x, int y) { return 10 * x + y; });
    SmallImage small = small_image(image, regions, 2);
    CHECK((small.inside.width == 3 && small.inside.height == 1));
    CHECK(small.inside.values == std::vector<std::uint8_t>{1, 1, 1});
    CHECK(small.luv.pixel(0, 0)[0] == 5.5f);
    CHECK(small.luv.pixel(1, 0)[0] == 21.0f);
    CHECK(small.luv.pixel(2, 0)[0] == 40.5f);
    regions.at(2, 1) = kNone;
    small = small_image(image, regions, 2);
    CHECK(small.inside.values == std::vector<std::uint8_t>{1, 0, 1});
    CHECK(small.luv.pixel(1, 0)[0] == 5.5f);  // as near as the right one, and first
}

TEST_CASE("clusters: pixels of equal values have one code, and few values have codes of their own") {
    const FeatureImage image = grey(20, 10, [](int x, int y) { return (x / 4) * 10 + (y / 5) * 50; });
    const Codes codes = palette(small_image(image, all_inside(20, 10), 1));
    std::map<float, std::uint8_t> code_of;
    for (std::size_t i = 0; i < codes.size(); ++i) {
        const auto [at, added] = code_of.emplace(image.pixel(i)[0], codes[i]);
        CHECK(at->second == codes[i]);
    }
    for (const auto& [value, code] : code_of)
        for (const auto& [other, other_code] : code_of) CHECK((value == other || code != other_code));
}

// Stripes of two directions have the same colours everywhere, and different textons.
TEST_CASE("textons tell stripes across from stripes along") {
    const FeatureImage image =
        grey(96, 64, [](int x, int y) { return 50 + 30 * std::sin((x < 48 ? x : y) * kPi / 4); });
    const Codes codes = textons(small_image(image, all_inside(96, 64), 1));
    std::array<std::array<double, kCodes>, 2> share{};
    for (int y = 12; y < 52; ++y)
        for (int x = 8; x < 88; ++x)
            if (x < 36 || x >= 60) share[x < 48 ? 0 : 1][codes.at(x, y)] += 1.0 / (28 * 40);
    double common = 0;
    for (std::size_t k = 0; k < kCodes; ++k) common += std::min(share[0][k], share[1][k]);
    CHECK(common < 0.05);
}

// Two plain halves differ in everything but texture; the contrast falls as the disc is turned.
TEST_CASE("half discs: greatest across the edge, none along it, as if mirrored") {
    const FeatureImage image = grey(96, 64, [](int x, int) { return x < 48 ? 40 : 46; });
    const HalfDiscs discs(small_image(image, all_inside(96, 64), 1));
    const Crack crack{47, 32, false};
    const float across = discs.contrast(crack, 0), along = discs.contrast(crack, kPi / 2);
    const double color = 1 - std::exp(-36 / (8 * 36.0));
    CHECK(across >= doctest::Approx(0.45 * color + 0.2));
    CHECK(across <= doctest::Approx(0.45 * color + 0.2 + 0.35));
    CHECK(along < 0.03f);
    float last = across;
    for (int k = 1; k <= 8; ++k) {
        const float turned = discs.contrast(crack, k * kPi / 16);
        CHECK(turned < last);
        CHECK(turned == doctest::Approx(discs.contrast(crack, k * kPi / 16 + kPi)).epsilon(1e-5));
        CHECK(turned == doctest::Approx(discs.contrast(crack, -k * kPi / 16)).epsilon(0.1));
        last = turned;
    }
    CHECK(discs.contrast({5, 32, false}, 0) < 0.01f);
    CHECK(discs.contrast({0, 0, true}, 1) < 0.01f);  // cut by the frame
}

// Rows and columns are treated alike.
TEST_CASE("half discs: an image and its transpose") {
    const auto lightness = [](int x, int y) { return (x * x + 7 * y + (x * y) % 11) % 60; };
    const HalfDiscs discs(small_image(grey(40, 40, lightness), all_inside(40, 40), 1));
    const HalfDiscs flipped(
        small_image(grey(40, 40, [&](int x, int y) { return lightness(y, x); }), all_inside(40, 40), 1));
    for (const int x : {3, 17, 30})
        CHECK(discs.contrast({x, 20, false}, 0) ==
              doctest::Approx(flipped.contrast({20, x, true}, kPi / 2)).epsilon(0.2));
}

TEST_CASE("majority: notches and thin lines go, straight outlines stay") {
    LabelImage labels = halves(40, 30);
    CHECK(smooth_outlines(labels, 4).values == labels.values);
    LabelImage ragged = labels;
    for (const int y : {8, 9, 20}) ragged.at(20, y) = 0;
    ragged.at(19, 14) = 1;
    CHECK(smooth_outlines(ragged, 4).values == labels.values);
    CHECK(smooth_outlines(ragged, 0).values == ragged.values);
    for (int y = 0; y < 30; ++y) ragged.at(30, y) = 0;  // a line apart: its part of the label vanishes
    CHECK(smooth_outlines(ragged, 4).values == labels.values);
}

TEST_CASE("majority: what falls apart becomes several regions, and outside stays outside") {
    LabelImage labels(Grid<Id>(GridSize{30, 9}, 0), 2);
    for (int y = 0; y < 9; ++y) labels.at(15, y) = kNone;
    labels.at(3, 3) = 1;
    const LabelImage smooth = smooth_outlines(labels, 3);
    CHECK(smooth.count == 2);
    CHECK(smooth.at(0, 0) == 0);
    CHECK(smooth.at(3, 3) == 0);
    CHECK(smooth.at(15, 4) == kNone);
    CHECK(smooth.at(29, 0) == 1);
}

TEST_CASE("contrasts along an outline at two sizes") {
    for (const int scale : {1, 3}) {
        const int width = 481 * scale, height = 321 * scale;
        const FeatureImage image = grey(width, height, [&](int x, int) { return x < width / 2 ? 30 : 70; });
        const LabelImage labels = halves(width, height);
        const PairContrasts contrasts = contour_contrasts(image, labels);
        for (int y = 0; y < height; ++y) CHECK(contrasts.right[labels.index(width / 2 - 1, y)] > 0.55f);
        CHECK(*std::max_element(contrasts.down.begin(), contrasts.down.end()) == 0.0f);
    }
}

// Noise of many regions: any number of threads, and every image however thin.
TEST_CASE("contrasts: the same for any number of threads, and of any image") {
    for (const auto& [width, height] :
         {std::pair(1, 1), {1, 50}, {50, 1}, {2, 2}, {3, 3}, {70, 90}, {2, 90000}}) {
        std::mt19937 random(7);
        const FeatureImage image = grey(width, height, [&](int, int) { return random() % 100; });
        LabelImage labels(Grid<Id>(GridSize{width, height}, 0), 4);
        for (Id& label : labels) label = random() % 5 == 4 ? kNone : Id(random() % 4);
        labels[0] = 0;
        const PairContrasts one = [&] {
            const ThreadLimit limit(1);
            return contour_contrasts(image, labels);
        }();
        const PairContrasts many = contour_contrasts(image, labels);
        CHECK(one.right == many.right);
        CHECK(one.down == many.down);
        for (const float value : one.right) CHECK((value >= 0 && value <= 1));
    }
}

// Patches of 4x4 pixels in plain squares of 20x20: smoothing cuts off corners of patches, which are cells of
// one pixel. No region is that small.
TEST_CASE("min size: holds for cells that smoothed outlines cut off") {
    constexpr int kSide = 200;
    std::vector<Id> faces;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) faces.push_back(Id(y / 4 * (kSide / 4) + x / 4));
    const PixelMap map = map_of_faces(kSide, kSide, faces);
    const FeatureImage image =
        grey(kSide, kSide, [](int x, int y) { return (x / 20 * 7 + y / 20 * 3) % 10 * 10; });
    const auto smallest = [&](std::int64_t min_size) {
        const auto [cells, hierarchy] = contour_hierarchy(map, image, SegmentQuality::kDefault, min_size, {});
        const LabelImage labels = labels_after(cells, hierarchy, hierarchy.forced);
        std::vector<std::int64_t> sizes(labels.count, 0);
        for (const Id label : labels) ++sizes[label];
        return *std::min_element(sizes.begin(), sizes.end());
    };
    CHECK(smallest(1) == 1);
    CHECK(smallest(2) >= 2);
    CHECK(smallest(50) >= 50);
}

// Several pairs share a place of the small image. The first of them tells the direction, in whichever window
// it is.
TEST_CASE("contrasts of windows are those of the whole picture") {
    constexpr int kWidth = 60, kHeight = 40, kFactor = 3;
    std::mt19937 random(3);
    const FeatureImage image = grey(kWidth, kHeight, [&](int x, int) { return x + int(random() % 40); });
    Grid<Id> regions(GridSize{kWidth, kHeight});
    for (std::size_t i = 0; i < regions.size(); ++i)
        regions[i] = Id(regions.x_of(i) / 7 + regions.y_of(i) / 5 * 10 + int(random() % 12 == 0));
    const auto contrasts = [&](const std::vector<PixelRect>& parts) {
        ContourPlaces places(image, kFactor);
        const auto each_window = [&](int margin, const auto& act) {
            for (const PixelRect& part : parts) {
                const PixelRect rect{std::max(0, part.left - margin), std::max(0, part.top - margin),
                                     std::min(kWidth, part.right + margin),
                                     std::min(kHeight, part.bottom + margin)};
                Grid<Id> window(GridSize{rect.width(), rect.height()});
                for (std::size_t i = 0; i < window.size(); ++i)
                    window[i] = regions.at(rect.left + window.x_of(i), rect.top + window.y_of(i));
                act(window, rect,
                    PixelRect{part.left - rect.left, part.top - rect.top, part.right - rect.left,
                              part.bottom - rect.top});
            }
        };
        each_window(places.margin(), [&](const Grid<Id>& window, const PixelRect& at, const PixelRect& own) {
            places.add(window, at.left, at.top, own);
        });
        places.measure(small_image(image, regions, kFactor));
        PairContrasts all{std::vector<float>(regions.size()), std::vector<float>(regions.size())};
        each_window(1, [&](const Grid<Id>& window, const PixelRect& at, const PixelRect& own) {
            const PairContrasts found = places.contrasts(window, at.left, at.top, own);
            for (std::size_t i = 0; i < window.size(); ++i) {
                const std::size_t j = regions.index(at.left + window.x_of(i), at.top + window.y_of(i));
                all.right[j] += found.right[i];
                all.down[j] += found.down[i];
            }
        });
        return all;
    };
    const PairContrasts whole = contrasts({{0, 0, kWidth, kHeight}});
    // The right half first, so that a place is often found before its first pair.
    const PairContrasts halves = contrasts({{31, 0, kWidth, kHeight}, {0, 17, 31, kHeight}, {0, 0, 31, 17}});
    CHECK(whole.right == halves.right);
    CHECK(whole.down == halves.down);
    CHECK(std::ranges::count(whole.right, 0.0f) < std::ranges::ssize(whole.right));
}
