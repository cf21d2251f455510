// Seeds: compared with a slow clear way, and with floods over the contour map.
#include <doctest/doctest.h>

#include <algorithm>
#include <queue>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/grid_neighbors.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/seeds.h"
#include "tests/support/segment_maps.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr int kWidth = 12, kHeight = 9;

// Patches of a few pixels with grey values of few kinds, so that there are many equal heights.
Segmentation sample(std::uint32_t number, bool mask) {
    std::mt19937 random(number);
    std::vector<Id> faces;
    FeatureImage picture{kWidth, kHeight, 3, {}};
    for (int i = 0; i < kWidth * kHeight; ++i) {
        const int x = i % kWidth, y = i / kWidth;
        faces.push_back(mask && random() % 6 == 0 ? kNone : static_cast<Id>(y / 2 * 6 + x / 2));
        picture.data.insert(picture.data.end(), {float(random() % 4) * 10, 0, 0});
    }
    SegmentParams params;
    params.distance = number % 2 == 0 ? DistanceRule::kPaper : DistanceRule::kContour;
    return segment(level_of(map_of_faces(kWidth, kHeight, faces)), picture, params);
}

std::vector<Seed> some_seeds(const Segmentation& result, std::mt19937& random) {
    std::vector<Seed> seeds;
    std::vector<int> kind(result.cells.count(), -1);
    for (int k = 0; k < 5; ++k) {
        const auto x = static_cast<int>(random() % kWidth), y = static_cast<int>(random() % kHeight);
        const Id cell = result.cells.at(x, y);
        if (cell == kNone || (kind[cell] >= 0 && kind[cell] != k % 2)) continue;
        kind[cell] = k % 2;
        seeds.push_back({{{x, y}}, k % 2 == 0, "seed"});
    }
    return seeds;
}

// The smallest height that must be crossed on the way from each pixel to a seed of this kind.
std::vector<float> flood(const ContourMap& map, std::span<const Seed> seeds, bool keep) {
    const GridSize size{kWidth, kHeight};
    std::vector<float> height(size.pixel_count(), std::numeric_limits<float>::infinity());
    for (const Seed& seed : seeds)
        if (seed.keep == keep) height[size.index(int(seed.points[0].x), int(seed.points[0].y))] = 0;
    for (bool changed = true; changed;) {
        changed = false;
        for_neighbor_pixels(size, [&](std::size_t i, std::size_t j) {
            const float wall = map.at(size.x_of(i) + size.x_of(j) + 1, size.y_of(i) + size.y_of(j) + 1);
            for (const auto& [from, to] : {std::pair(i, j), std::pair(j, i)}) {
                const float through = std::max(height[from], wall);
                if (through < height[to]) {
                    height[to] = through;
                    changed = true;
                }
            }
        });
    }
    return height;
}

// The rule as seeds.h states it, from all labels after every number of merges.
std::vector<std::uint8_t> slow(const Segmentation& result, std::span<const Seed> seeds) {
    std::vector<int> kind(result.cells.size(), 0);  // 1 kept, 2 dropped
    for (const Seed& seed : seeds) {
        const Id cell = result.cells.at(int(seed.points[0].x), int(seed.points[0].y));
        for (std::size_t i = 0; i < kind.size(); ++i)
            if (result.cells[i] == cell) kind[i] = seed.keep ? 1 : 2;
    }
    for (std::size_t merges = 1; merges <= result.hierarchy.merges.size(); ++merges) {
        const LabelImage labels = labels_after(result.cells, result.hierarchy, merges);
        for (Id region = 0; region < labels.count; ++region) {
            std::int64_t border[3] = {0, 0, 0};
            for_neighbor_pixels(labels, [&](std::size_t i, std::size_t j) {
                if (labels[i] != region || labels[j] != region) return;
                if (kind[i] == 0) ++border[kind[j]];
                if (kind[j] == 0) ++border[kind[i]];
            });
            if (border[1] + border[2] == 0) continue;
            for (std::size_t i = 0; i < kind.size(); ++i)
                if (labels[i] == region && kind[i] == 0) kind[i] = border[1] > border[2] ? 1 : 2;
        }
    }
    std::vector<std::uint8_t> kept;
    for (const int k : kind) kept.push_back(k == 1);
    return kept;
}

}  // namespace

TEST_CASE("seeds of both kinds: the earlier merge decides, then the longer border") {
    std::mt19937 random(7);
    int ties = 0;
    for (std::uint32_t number = 0; number < 60; ++number) {
        const Segmentation result = sample(number, number % 3 == 0);
        const std::vector<Seed> seeds = some_seeds(result, random);
        if (std::ranges::all_of(seeds, &Seed::keep) || std::ranges::none_of(seeds, &Seed::keep)) continue;
        INFO("sample " << number);
        const Mask mask = choose_by_seeds(result, seeds);
        REQUIRE(mask.values == slow(result, seeds));
        const ContourMap map = contour_map(result.cells, result.hierarchy);
        const std::vector<float> to_keep = flood(map, seeds, true), to_drop = flood(map, seeds, false);
        for (std::size_t i = 0; i < mask.size(); ++i) {
            if (to_keep[i] == to_drop[i])
                ++ties;
            else if (result.cells[i] != kNone)
                REQUIRE((mask[i] != 0) == (to_keep[i] < to_drop[i]));
        }
    }
    CHECK(ties > 100);  // the longer border was asked
}

// A row of four regions, the last beyond a mask.
TEST_CASE("seeds of one kind choose regions") {
    const FeatureImage picture{6, 1, 3, {0, 0, 0, 0, 0, 0, 50, 0, 0, 90, 0, 0, 0, 0, 0, 10, 0, 0}};
    const Level level = level_of(map_of_faces(6, 1, {0, 1, 2, 3, kNone, 4}));
    SegmentParams params;
    params.distance = DistanceRule::kPaper;
    const Segmentation result = segment(level, picture, params);
    REQUIRE(result.labels.values == std::vector<Id>{0, 0, 1, 2, kNone, 3});
    using Values = std::vector<std::uint8_t>;
    const auto chosen = [&](const std::vector<Seed>& seeds) { return choose_by_seeds(result, seeds).values; };
    CHECK(chosen({{{{1, 0}}, true, ""}}) == Values{1, 1, 0, 0, 0, 0});
    CHECK(chosen({{{{1, 0}}, true, ""}, {{{5, 0}}, true, ""}}) == Values{1, 1, 0, 0, 0, 1});
    CHECK(chosen({{{{1, 0}}, false, ""}}) == Values{0, 0, 1, 1, 0, 1});
    CHECK(chosen({{{{2, 0}, {5, 0}}, false, ""}}) == Values{1, 1, 0, 0, 0, 0});  // a line, across the mask
    // Both: 50 and 90 merge first, and then with 0; the island with no seed goes.
    CHECK(chosen({{{{0, 0}}, true, ""}, {{{3, 0}}, false, ""}}) == Values{1, 1, 0, 0, 0, 0});
    CHECK(chosen({{{{3, 0}}, true, ""}, {{{0, 0}}, false, ""}}) == Values{0, 0, 1, 1, 0, 0});
}

TEST_CASE("seeds that cannot be") {
    const FeatureImage picture{3, 1, 3, {0, 0, 0, 0, 0, 0, 50, 0, 0}};
    const Segmentation result = segment(level_of(map_of_faces(3, 1, {0, 0, kNone})), picture, {});
    const auto refused = [&](const std::vector<Seed>& seeds) {
        try {
            choose_by_seeds(result, seeds);
        } catch (const Error& error) {
            return std::pair(error.kind(), std::string(error.what()));
        }
        return std::pair(ErrorKind::kInternal, std::string());
    };
    CHECK(refused({}).first == ErrorKind::kBadArgument);
    for (const Seed::Point& p : {Seed::Point{3, 0}, {-1, 0}, {0, 1}, {std::int64_t{1} << 40, 0}})
        CHECK(refused({{{p}, true, "k"}}).second.starts_with(cat("k: pixel ", p.x, ",", p.y, " is outside")));
    CHECK(refused({{{{2, 0}}, true, "k"}}) ==
          std::pair(ErrorKind::kBadArgument, std::string("k: is outside the mask")));
    CHECK(refused({{{{0, 0}}, true, "k"}, {{{1, 0}}, false, "d"}})
              .second.starts_with("k and d lie in one patch"));
    CHECK(refused({{{{0, 0}}, false, "d"}}).first == ErrorKind::kUnsupported);
}
