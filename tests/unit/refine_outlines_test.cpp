// Outlines of regions, moved pixel by pixel: truths by hand, and laws.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "libcore/segment/refine_outlines.h"

using namespace imgmesh;

namespace {

FeatureImage uniform(const GridSize& size, float lightness) {
    FeatureImage image(size.width, size.height, 3, std::vector<float>(size.pixel_count() * 3));
    for (std::size_t i = 0; i < size.pixel_count(); ++i) image.pixel(i)[0] = lightness;
    return image;
}

// The number of pixels that lie right of `edge` with label 0, or left of it with label 1.
int wrong_side(const LabelImage& labels, int edge) {
    int wrong = 0;
    for (int y = 0; y < labels.height; ++y)
        for (int x = 0; x < labels.width; ++x) wrong += (labels.at(x, y) == 1) != (x >= edge);
    return wrong;
}

// Two regions whose common outline is ragged: each row's lies up to 4 pixels off column 16.
LabelImage ragged_halves() {
    LabelImage labels(Grid<Id>(GridSize{32, 24}), 2);
    for (int y = 0; y < 24; ++y)
        for (int x = 0; x < 32; ++x) labels.at(x, y) = x >= 12 + y * 5 % 9 ? 1 : 0;
    return labels;
}

// The sums of the header for a uniform image.
double energy(const LabelImage& labels, const OutlineParams& params) {
    std::vector<double> n(labels.count), x(n), y(n), squares(n);
    double length = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels[i] == kNone) continue;
        const int px = labels.x_of(i), py = labels.y_of(i);
        const Id label = labels[i];
        n[label] += 1;
        x[label] += px;
        y[label] += py;
        squares[label] += px * px + py * py;
        const int steps[4][2] = {{1, 0}, {0, 1}, {1, 1}, {-1, 1}};
        for (const auto& [sx, sy] : steps) {
            if (!labels.contains(px + sx, py + sy)) continue;
            const Id other = labels.at(px + sx, py + sy);
            if (other != kNone && other != label) length += sx == 0 || sy == 0 ? 1 : std::sqrt(0.5);
        }
    }
    double sum = 0;
    for (std::size_t r = 0; r < labels.count; ++r) sum += squares[r] - (x[r] * x[r] + y[r] * y[r]) / n[r];
    const double c2 = params.compactness * params.compactness;
    return c2 * sum / (params.spacing * params.spacing) + c2 * length;
}

}  // namespace

TEST_CASE("outlines go to the edge of two colours") {
    LabelImage labels = ragged_halves();
    FeatureImage image = uniform(labels, 20);
    for (std::size_t i = 0; i < labels.size(); ++i)
        if (labels.x_of(i) >= 16) image.pixel(i)[0] = 70;
    REQUIRE(wrong_side(labels, 16) > 20);
    refine_outlines(labels, image, {5, 16, 1});
    CHECK(wrong_side(labels, 16) == 0);
}

TEST_CASE("without an edge outlines become straight, and without a price nothing moves") {
    LabelImage labels = ragged_halves();
    const LabelImage before = labels;
    const FeatureImage image = uniform(labels, 50);
    refine_outlines(labels, image, {0, 16, 1});
    CHECK(labels.values == before.values);
    refine_outlines(labels, image, {5, 16, 1});
    std::vector<int> left(24, 0);
    for (std::size_t i = 0; i < labels.size(); ++i) left[as_index(labels.y_of(i))] += labels[i] == 0 ? 1 : 0;
    const auto [least, most] = std::minmax_element(left.begin(), left.end());
    CHECK(*most - *least <= 1);  // it was 8
}

// A line of one pixel's width between two regions of its colour: any of its inner pixels would cut it in two.
TEST_CASE("a region is neither cut nor emptied, and keeps the least size") {
    LabelImage line(Grid<Id>(GridSize{9, 7}), 3);
    for (std::size_t i = 0; i < line.size(); ++i) line[i] = line.y_of(i) < 3 ? 0 : line.y_of(i) > 3 ? 2 : 1;
    const FeatureImage image = uniform(line, 50);
    for (const std::int64_t least : {1, 5, 20}) {
        LabelImage labels = line;
        refine_outlines(labels, image, {100, 1, least});
        std::vector<std::int64_t> sizes(3, 0);
        for (const Id label : labels) ++sizes[label];
        for (const std::int64_t size : sizes) CHECK(size >= std::min(least, std::int64_t{9}));
    }
}

TEST_CASE("pixels outside the mask stay outside, and their colours do not count") {
    LabelImage labels = ragged_halves();
    FeatureImage image = uniform(labels, 20);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (labels.x_of(i) >= 16) image.pixel(i)[0] = 70;
        if (labels.y_of(i) < 12) continue;
        labels[i] = kNone;
        image.pixel(i)[0] = 1e6f;
    }
    refine_outlines(labels, image, {5, 16, 1});
    for (std::size_t i = 0; i < labels.size(); ++i)
        CHECK(labels[i] == (labels.y_of(i) >= 12 ? kNone : Id(labels.x_of(i) >= 16)));
}

TEST_CASE("images of one pixel, one row and one column") {
    for (const GridSize size : {GridSize{1, 1}, GridSize{7, 1}, GridSize{1, 7}}) {
        LabelImage labels(Grid<Id>(size, 0), 1);
        if (size.pixel_count() == 7) {
            labels.count = 2;
            for (std::size_t i = 5; i < 7; ++i) labels[i] = 1;
        }
        FeatureImage image = uniform(size, 20);
        for (std::size_t i = 3; i < size.pixel_count(); ++i) image.pixel(i)[0] = 80;
        refine_outlines(labels, image, {5, 3, 1});
        for (std::size_t i = 0; i < labels.size(); ++i) CHECK(labels[i] == Id(i >= 3));
    }
}

TEST_CASE("the energy falls") {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        std::mt19937 random(seed);
        // Bars of random widths in three bands, with combs for sides.
        LabelImage labels(Grid<Id>(GridSize{40, 30}), 0);
        for (int band = 0; band < 3; ++band) {
            int left = 0;
            while (left < 40) {
                const int right = std::min<int>(40, left + 3 + static_cast<int>(random() % 12));
                for (int y = band * 10; y < band * 10 + 10; ++y)
                    for (int x = left + (left > 0 && y % 2 == 0); x < 40; ++x)
                        labels.at(x, y) = as_id(labels.count);
                ++labels.count;
                left = right;
            }
        }
        const OutlineParams params{7, 9, 1};
        const double before = energy(labels, params);
        refine_outlines(labels, uniform(labels, 50), params);
        CHECK(energy(labels, params) < before);
    }
}
