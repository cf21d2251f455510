// Borders of regions as lines: what they enclose is the regions, and neighbours share them.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/error.h"
#include "libcore/base/grid_neighbors.h"
#include "libcore/segment/region_outlines.h"
#include "libcore/segment/regions_svg.h"

using namespace imgmesh;

namespace {

// Connected parts of blocks of random values; with a mask some of them are outside.
LabelImage random_labels(int width, int height, int block, bool mask, std::mt19937& random) {
    const GridSize blocks{width / block + 1, height / block + 1};
    Grid<int> value(blocks);
    for (int& v : value) v = static_cast<int>(random() % 4);
    const GridSize size{width, height};
    const auto at = [&](std::size_t i) { return value.at(size.x_of(i) / block, size.y_of(i) / block); };
    DisjointSets sets(size.pixel_count());
    for_neighbor_pixels(size, [&](std::size_t i, std::size_t j) {
        if (at(i) == at(j)) sets.join(as_id(i), as_id(j));
    });
    LabelImage labels(Grid<Id>(size, kNone), 0);
    for (std::size_t i = 0; i < labels.size(); ++i) {
        if (mask && at(i) == 0) continue;
        const Id first = sets.find(as_id(i));
        labels[i] = first == i ? as_id(labels.count++) : labels[first];
    }
    return labels;
}

std::vector<Vec2d> points_of(const OutlineArc& arc, bool reversed) {
    std::vector<Vec2d> points = {arc.start};
    for (const OutlineStep& step : arc.steps) {
        const Vec2d from = points.back();
        constexpr int kPieces = 32;
        for (int k = 1; step.curve && k < kPieces; ++k) {
            const double t = double(k) / kPieces;
            points.emplace_back((1 - t) * (1 - t) * from + 2 * t * (1 - t) * step.control + t * t * step.end);
        }
        points.push_back(step.end);
    }
    if (reversed) std::reverse(points.begin(), points.end());
    return points;
}

// Twice the area on the left of a closed polygon on screen.
double area_of(const std::vector<Vec2d>& ring) {
    double sum = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const Vec2d& a = ring[i];
        const Vec2d& b = ring[(i + 1) % ring.size()];
        sum += b.x() * a.y() - a.x() * b.y();
    }
    return sum;
}

void check_outlines(const LabelImage& labels, double tolerance) {
    const RegionOutlines outlines = region_outlines(labels, tolerance);
    std::vector<std::set<std::size_t>> left(outlines.arcs.size()), right(outlines.arcs.size());
    Grid<int> covered(labels, 0);
    double total = 0;
    for (Id region = 0; region < labels.count; ++region) {
        Grid<int> crossings(labels, 0);
        for (const OutlineRing& ring : outlines.rings[region]) {
            std::vector<Vec2d> points;
            for (const DirectedArc& part : ring) {
                const OutlineArc& arc = outlines.arcs[part.arc];
                REQUIRE((part.reversed ? arc.right : arc.left) == region);
                REQUIRE((part.reversed ? right : left)[part.arc].insert(region).second);
                const std::vector<Vec2d> more = points_of(arc, part.reversed);
                REQUIRE((points.empty() || points.back() == more.front()));
                points.insert(points.end(), more.begin() + (points.empty() ? 0 : 1), more.end());
            }
            REQUIRE(points.front() == points.back());
            points.pop_back();
            total += area_of(points);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Vec2d& a = points[i];
                const Vec2d& b = points[(i + 1) % points.size()];
                for (int y = 0; y < labels.height; ++y) {
                    const double at = y + 0.5;
                    if ((a.y() < at) == (b.y() < at)) continue;
                    const double x = a.x() + (at - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
                    for (int k = 0; k < labels.width; ++k) crossings.at(k, y) += x < k + 0.5 ? 1 : 0;
                }
            }
        }
        for (std::size_t i = 0; i < labels.size(); ++i) {
            REQUIRE((crossings[i] % 2 == 1) == (labels[i] == region));
            covered[i] += crossings[i] % 2;
        }
    }
    std::size_t inside = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
        REQUIRE(covered[i] == (labels[i] == kNone ? 0 : 1));
        inside += labels[i] != kNone ? 1 : 0;
    }
    // Each line is on the left of one region and on the right of another, or on the frame or mask.
    for (std::size_t k = 0; k < outlines.arcs.size(); ++k) {
        const OutlineArc& arc = outlines.arcs[k];
        CHECK(left[k].size() == (arc.left == kNone ? 0 : 1));
        CHECK(right[k].size() == (arc.right == kNone ? 0 : 1));
        CHECK(left[k] != right[k]);
        for (const OutlineStep& step : arc.steps) {
            CHECK((step.end.array() >= 0).all());
            CHECK(step.end.x() <= labels.width);
            CHECK(step.end.y() <= labels.height);
        }
    }
    if (inside == labels.size() || tolerance == 0)  // no gap and no overlap
        CHECK(total / 2 == doctest::Approx(double(inside)));
}

}  // namespace

TEST_CASE("outlines: every centre stays in its region, neighbours share every line") {
    std::mt19937 random(11);
    for (int number = 0; number < 40; ++number) {
        const int width = 1 + static_cast<int>(random() % 16), height = 1 + static_cast<int>(random() % 16);
        const LabelImage labels = random_labels(width, height, 1 + number % 3, number % 2 == 1, random);
        INFO("sample " << number);
        for (const double tolerance : {0.0, 0.1, 0.35, 0.5}) check_outlines(labels, tolerance);
    }
}

// A slope of stairs is one straight line, and the frame keeps its corners.
TEST_CASE("outlines: stairs become a straight line") {
    LabelImage labels(Grid<Id>({40, 21}, 0), 2);
    for (int y = 0; y < 21; ++y)
        for (int x = 2 * y; x < 40; ++x) labels.at(x, y) = 1;
    for (const double tolerance : {0.0, 0.5}) {
        const RegionOutlines outlines = region_outlines(labels, tolerance);
        for (const OutlineArc& arc : outlines.arcs)
            if (arc.left != kNone && arc.right != kNone) CHECK(arc.steps.size() <= (tolerance == 0 ? 40 : 5));
        check_outlines(labels, tolerance);
    }
    const RegionOutlines whole = region_outlines(LabelImage(Grid<Id>({3, 2}, 0), 1), 0.5);
    CHECK(regions_svg(whole, {Vec3f::Zero()}).find("d=\"M3 0L0 0L0 2L3 2L3 0Z\"") != std::string::npos);
}

TEST_CASE("outlines: a pixel alone, and one that touches another in a corner") {
    check_outlines(LabelImage(Grid<Id>({1, 1}, 0), 1), 0.5);
    check_outlines(LabelImage({2, 2, {0, 1, 2, 3}}, 4), 0.5);
    check_outlines(LabelImage({2, 2, {0, kNone, kNone, 1}}, 2), 0.5);
    check_outlines(LabelImage({3, 3, {0, 0, 0, 0, 1, 0, 0, 0, 0}}, 2), 0.5);  // a hole
    check_outlines(LabelImage({3, 3, {kNone, 0, 0, 0, kNone, 0, 0, 0, 0}}, 1),
                   0.5);  // a ring that meets itself
    for (const double tolerance : {-0.1, 0.51, std::nan("")})
        CHECK_THROWS_AS(region_outlines(LabelImage(Grid<Id>({1, 1}, 0), 1), tolerance), Error);
}
