// Segmentation: laws that hold for every image.
#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "libcore/base/grid_neighbors.h"
#include "libcore/base/parallel.h"
#include "libcore/segment/contour_map.h"
#include "libcore/segment/pair_contrasts.h"
#include "libcore/segment/region_distance.h"
#include "libcore/segment/segment.h"
#include "tests/support/segment_maps.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// Returns the connected parts of a graph over the pixels, numbered by their first pixel; kNone stays.
std::vector<Id> parts(std::size_t count, const std::vector<std::pair<std::size_t, std::size_t>>& joined,
                      const std::vector<Id>& inside) {
    std::vector<std::size_t> parent(count);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t i) {
        while (parent[i] != i) i = parent[i];
        return i;
    };
    for (const auto& [i, j] : joined) {
        const std::size_t a = root(i), b = root(j);
        parent[std::max(a, b)] = std::min(a, b);
    }
    std::vector<Id> label(count, kNone);
    Id next = 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (inside[i] == kNone) continue;
        const std::size_t r = root(i);
        label[i] = r == i ? next++ : label[r];
    }
    return label;
}

// Returns the 4-connected parts of every label's pixels.
std::vector<Id> connected_parts(const LabelImage& labels) {
    std::vector<std::pair<std::size_t, std::size_t>> joined;
    for_neighbor_pixels(labels, [&](std::size_t i, std::size_t j) {
        if (labels[i] == labels[j]) joined.emplace_back(i, j);
    });
    return parts(labels.size(), joined, labels.values);
}

std::vector<Id> regions_of_map(const ContourMap& map, double threshold, const std::vector<Id>& inside) {
    const int width = (map.width - 1) / 2, height = (map.height - 1) / 2;
    const auto value = [&](int x, int y) {
        return double(map.values[static_cast<std::size_t>(y * map.width + x)]);
    };
    std::vector<std::pair<std::size_t, std::size_t>> joined;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = static_cast<std::size_t>(y * width + x);
            if (x + 1 < width && value(2 * x + 2, 2 * y + 1) < threshold) joined.emplace_back(i, i + 1);
            if (y + 1 < height && value(2 * x + 1, 2 * y + 2) < threshold)
                joined.emplace_back(i, i + static_cast<std::size_t>(width));
        }
    return parts(inside.size(), joined, inside);
}

// Computes regions anew, pixel by pixel, before every choice.
std::vector<std::vector<Id>> slow_merges(const Sample& s, const RegionDistance& distance,
                                         const PairContrasts& contrasts, std::int64_t min_size) {
    Cells cells = cut_cells(s.level.map);
    std::vector<std::vector<Id>> steps = {cells.values};
    for (;;) {
        const RegionGraph graph = region_graph(cells, s.level.map, s.picture, contrasts);
        const Border* best = nullptr;
        std::tuple<bool, float, double> least;
        for (const Border& border : graph.borders) {
            const RegionSums &a = graph.regions[border.a], &b = graph.regions[border.b];
            const std::tuple<bool, float, double> key = {std::min(a.pixels, b.pixels) >= double(min_size),
                                                         static_cast<float>(distance(a, b, border)),
                                                         a.pixels + b.pixels};
            if (best && least <= key) continue;
            best = &border;
            least = key;
        }
        if (!best) return steps;
        for (Id& cell : cells.values) {
            if (cell == kNone || cell < best->b) continue;
            cell = cell == best->b ? best->a : cell - 1;
        }
        cells.face.pop_back();
        steps.push_back(cells.values);
    }
}

}  // namespace

TEST_CASE("merging agrees with regions made anew at every step") {
    for (std::uint32_t seed = 1; seed <= 12; ++seed) {
        const Sample s = sample(17, 13, 24, seed % 2 == 0, seed);
        INFO("seed " << seed);
        const Cells cells = cut_cells(s.level.map);
        const PairContrasts contrasts = pair_contrasts(s.picture, cells);
        const std::int64_t min_size = seed % 3 == 0 ? 9 : 1;
        for (const RegionDistance& distance :
             {paper_distance(), contour_distance(17 * 13), superpixel_distance(10, 4)}) {
            const auto steps = slow_merges(s, distance, contrasts, min_size);
            const Hierarchy fast =
                merge_regions(region_graph(cells, s.level.map, s.picture, contrasts), distance, min_size);
            REQUIRE(fast.merges.size() + 1 == steps.size());
            for (std::size_t k = 0; k < steps.size(); ++k)
                CHECK(labels_after(cells, fast, k).values == steps[k]);
            // Ended early: the same merges, as far as they go, and all that are forced.
            const Hierarchy some =
                merge_regions(region_graph(cells, s.level.map, s.picture, contrasts), distance, min_size, 8);
            REQUIRE(some.forced == fast.forced);
            REQUIRE(some.merges.size() ==
                    std::max(fast.forced, std::min(fast.merges.size(), cells.count() - std::size_t{8})));
            for (std::size_t k = 0; k < some.merges.size(); ++k) CHECK(some.merges[k].b == fast.merges[k].b);
        }
    }
}

// The promise of the map: one file instead of a run for every threshold. It is tested at, just above and
// between the existing heights.
TEST_CASE("contour map: any threshold gives the regions of the tool") {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const Sample s = sample(23, 19, 30, seed % 2 == 0, seed);
        INFO("seed " << seed);
        using enum DistanceRule;
        for (const auto& [rule, quality] : {std::pair(kContour, SegmentQuality::kDefault),
                                            {kContour, SegmentQuality::kFast},
                                            {kPaper, SegmentQuality::kDefault}})
            for (const std::int64_t min_size : {1, 12}) {
                SegmentParams params;
                params.distance = rule;
                params.quality = quality;
                params.min_size = min_size;
                const Segmentation whole = segment(s.level, s.picture, params);
                const ContourMap map = contour_map(whole.cells, whole.hierarchy);
                REQUIRE(map.values.size() == 47u * 39u);
                std::vector<double> thresholds = {1e-30, 1e30};
                for (const Merge& merge : whole.hierarchy.merges) {
                    if (merge.height == 0) continue;
                    thresholds.push_back(double(merge.height));
                    thresholds.push_back(std::nextafter(double(merge.height), 1e30));
                    thresholds.push_back(double(merge.height) * 1.01);
                }
                for (std::size_t k = 0; k < thresholds.size(); ++k) {
                    const LabelImage labels = labels_after(whole.cells, whole.hierarchy,
                                                           merges_below(whole.hierarchy, thresholds[k]));
                    CHECK(labels.values == regions_of_map(map, thresholds[k], labels.values));
                    if (k % 25 != 2) continue;
                    params.threshold = thresholds[k];
                    CHECK(segment(s.level, s.picture, params).labels.values == labels.values);
                }
            }
    }
}

// Cells inside a smoothed region merge first, regions after them; every number in between can be had.
TEST_CASE("contours: regions are connected, nested, and as many as asked for") {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const Sample s = sample(130, 110, 2500, seed % 2 == 0, seed);  // more than go on to the second stage
        INFO("seed " << seed);
        for (const std::int64_t min_size : {1, 2, 20}) {
            SegmentParams params;
            params.min_size = min_size;
            const Segmentation whole = segment(s.level, s.picture, params);
            const Hierarchy& hierarchy = whole.hierarchy;
            CHECK(std::is_sorted(hierarchy.merges.begin(), hierarchy.merges.end(),
                                 [](const Merge& a, const Merge& b) { return a.height < b.height; }));
            for (std::size_t k = hierarchy.forced; k <= hierarchy.merges.size(); k += 97) {
                const LabelImage labels = labels_after(whole.cells, hierarchy, k);
                CHECK(labels.count == hierarchy.cells - k);
                CHECK(connected_parts(labels) == labels.values);
            }
            if (seed % 2 == 0) continue;  // islands may be of any size
            const LabelImage labels = labels_after(whole.cells, hierarchy, hierarchy.forced);
            std::vector<std::int64_t> sizes(labels.count, 0);
            for (const Id label : labels) ++sizes[label];
            CHECK(*std::min_element(sizes.begin(), sizes.end()) >= min_size);
        }
    }
}

// Superpixels have no thresholds of their own: the map's lowest regions are they, and above, Ward's merges.
TEST_CASE("contour map of superpixels: the lowest regions are the superpixels") {
    for (std::uint32_t seed = 1; seed <= 8; ++seed) {
        const Sample s = sample(23, 19, 30, seed % 2 == 0, seed);
        INFO("seed " << seed);
        for (const std::int64_t number : {9, 60, 200}) {
            SegmentParams params;
            params.superpixels = number;
            const Segmentation whole = segment(s.level, s.picture, params);
            const ContourMap map = contour_map(whole.cells, whole.hierarchy);
            CHECK(regions_of_map(map, 1e-30, whole.labels.values) == whole.labels.values);
            for (const Merge& merge : whole.hierarchy.merges)
                for (const double t : {double(merge.height), std::nextafter(double(merge.height), 1e30)}) {
                    const LabelImage labels =
                        labels_after(whole.cells, whole.hierarchy, merges_below(whole.hierarchy, t));
                    CHECK(labels.values == regions_of_map(map, t, labels.values));
                }
        }
    }
}

TEST_CASE(
    "superpixels are connected, numbered by their first pixel, as many as asked for, and large enough") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        const bool mask = seed % 2 == 0;
        const Sample s = sample(31, 29, 60, mask, seed);
        INFO("seed " << seed);
        const auto pixels = std::count_if(s.level.map.begin(), s.level.map.end(),
                                          [](const PixelCoord& coord) { return coord.face != kNone; });
        // There are fewer than 200 patches.
        for (const std::int64_t number : {100, 200, 500, static_cast<int>(pixels)})
            for (const double compactness : {0.0, 5.0, 1e6}) {
                SegmentParams params;
                params.superpixels = number;
                params.compactness = compactness;
                const Segmentation result = segment(s.level, s.picture, params);
                INFO("number " << number << ", compactness " << compactness);
                CHECK(result.missed.empty());
                CHECK(result.labels.count == as_index(number));
                CHECK(connected_parts(result.labels) == result.labels.values);
            }
        if (mask) continue;  // islands may be of any size
        SegmentParams params;
        params.superpixels = 20;
        params.min_size = 15;
        const Segmentation result = segment(s.level, s.picture, params);
        CHECK(result.labels.count == 20);
        for (const RegionFacts& f : region_facts(result.labels, s.picture)) CHECK(f.pixels >= 15);
    }
}

TEST_CASE("regions are connected, numbered by their first pixel, as many as asked for, and large enough") {
    for (std::uint32_t seed = 1; seed <= 10; ++seed) {
        const Sample s = sample(31, 29, 60, seed % 2 == 0, seed);
        INFO("seed " << seed);
        SegmentParams params;
        const std::size_t islands = [&] {
            params.threshold = 1e30;
            return segment(s.level, s.picture, params).labels.count;
        }();
        for (const std::size_t extra : {0u, 1u, 7u}) {
            params.segments = static_cast<std::int64_t>(islands + extra);
            const LabelImage labels = segment(s.level, s.picture, params).labels;
            CHECK(labels.count == islands + extra);
            CHECK(connected_parts(labels) == labels.values);
        }
        if (seed % 2 == 0) continue;  // islands may be of any size
        params.segments.reset();
        params.min_size = 40;
        for (const double threshold : {1e-3, 1.0, 4.0, 20.0}) {
            params.threshold = threshold;
            for (const RegionFacts& f : region_facts(segment(s.level, s.picture, params).labels, s.picture))
                CHECK(f.pixels >= 40);
        }
    }
}

TEST_CASE("segmentation is the same for any number of threads") {
    const Sample s = sample(150, 120, 300, true, 5);
    for (const bool superpixels : {false, true}) {
        SegmentParams params;
        if (superpixels) params.superpixels = 100;
        std::vector<ContourMap> maps;
        for (const int threads : {1, 4}) {
            const ThreadLimit limit(threads);
            const Segmentation result = segment(s.level, s.picture, params);
            maps.push_back(contour_map(result.cells, result.hierarchy));
        }
        CHECK(maps[0].values == maps[1].values);
    }
}
