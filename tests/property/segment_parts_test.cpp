// Segmentation of pictures in parts: the same regions as in one piece.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/segment/connected_parts.h"
#include "libcore/segment/first_regions.h"
#include "libcore/segment/segment_parts.h"
#include "tests/support/segment_maps.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// Colours that add up without rounding, in whatever order.
Sample rounded(Sample s) {
    for (float& value : s.picture.data) value = std::round(value);
    for (PixelCoord& coord : s.level.map.values) {
        coord.u = std::round(coord.u * 64) / 64;
        coord.v = std::round(coord.v * 64) / 64;
    }
    return s;
}

std::vector<int> lines(int size, int step) {
    std::vector<int> at;
    for (int x = 0; x < size; x += step) at.push_back(x);
    at.push_back(size);
    return at;
}

PictureParts parts_of(const Sample& s, PartGrid grid) {
    return {grid, [&s, grid](int column, int row) -> PicturePart {
                const PixelRect rect = grid.rect(column, row);
                PicturePart part{{rect.width(), rect.height(), {}}, {rect.width(), rect.height(), 3, {}}};
                for (int y = rect.top; y < rect.bottom; ++y)
                    for (int x = rect.left; x < rect.right; ++x) {
                        part.map.values.push_back(s.level.map.at(x, y));
                        const float* const luv = s.picture.pixel(x, y);
                        part.luv.data.insert(part.luv.data.end(), luv, luv + 3);
                    }
                const bool is_empty =
                    std::ranges::all_of(part.map.values, [](const PixelCoord& c) { return c.face == kNone; });
                return is_empty ? PicturePart{} : part;
            }};
}

PictureParts parts_of(const Sample& s, int step) {
    return parts_of(s, {lines(s.picture.width, step), lines(s.picture.height, step)});
}

// Patches end at the parts' sides, as those of tiles do.
void cut_faces(Sample& s, int step) {
    const int columns = s.picture.width / step + 1;
    for (std::size_t i = 0; i < s.level.map.size(); ++i) {
        Id& face = s.level.map.values[i].face;
        if (face == kNone) continue;
        face += 10000 * as_id(as_index(s.level.map.y_of(i) / step * columns + s.level.map.x_of(i) / step));
    }
}

std::vector<Id> all_labels(const PartSegmentation& s) {
    const GridSize size = s.labels.grid().size();
    return s.labels.window({0, 0, size.width, size.height}).values;
}

std::vector<SegmentParams> rules() {
    std::vector<SegmentParams> all(6);
    all[1].quality = SegmentQuality::kFast;
    all[2].distance = DistanceRule::kPaper;
    all[3].min_size = 30;
    all[4].clearest = true;
    all[5].segments = 7;
    return all;
}

// The heights of the last stage's merges say more than the regions of one threshold.
void check_same(const Sample& s, const PictureParts& parts, const SegmentParams& params) {
    const Segmentation whole = segment(s.level, s.picture, params);
    const PartSegmentation pieces = segment_parts(parts, params);
    CHECK(pieces.count == whole.labels.count);
    CHECK(all_labels(pieces) == whole.labels.values);
    const std::vector<Merge>&all = whole.hierarchy.merges, &last = pieces.hierarchy.merges;
    REQUIRE(last.size() <= all.size());
    for (std::size_t k = 1; k <= last.size(); ++k)
        CHECK(last[last.size() - k].height == all[all.size() - k].height);
}

// Stripes, and a grid of patches finer than they are.
Sample flat_areas(int width, int height, int patch, const auto& lightness) {
    std::vector<Id> faces;
    Sample s;
    s.picture = FeatureImage(width, height, 3, {});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            faces.push_back(as_id(as_index(y / patch * width + x / patch)));
            const float luv[] = {float(lightness(x, y)), 0, 0};
            s.picture.data.insert(s.picture.data.end(), luv, luv + 3);
        }
    s.level = level_of(map_of_faces(width, height, faces));
    return s;
}

}  // namespace

TEST_CASE("labels in parts: windows, numbers and counts are those of the picture") {
    const PartGrid grid{{0, 3, 5, 9}, {0, 4, 6}};
    Grid<Id> whole(GridSize{9, 6});
    for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = i % 11 == 0 ? kNone : as_id(i / 2 % 5);
    PartLabels labels(grid);
    for (int row = 0; row < 2; ++row)
        for (int column = 0; column < 3; ++column) {
            const PixelRect rect = grid.rect(column, row);
            Grid<Id> part(GridSize{rect.width(), rect.height()});
            for (int y = 0; y < part.height; ++y)
                for (int x = 0; x < part.width; ++x) part.at(x, y) = whole.at(rect.left + x, rect.top + y);
            labels.set(column, row, part);
        }
    const auto check = [&] {
        for (const PixelRect& rect : {PixelRect{0, 0, 9, 6}, {2, 1, 8, 5}, {4, 4, 5, 5}, {8, 5, 9, 6}}) {
            const Grid<Id> window = labels.window(rect);
            for (int y = 0; y < window.height; ++y)
                for (int x = 0; x < window.width; ++x)
                    CHECK(window.at(x, y) == whole.at(rect.left + x, rect.top + y));
        }
    };
    check();
    CHECK(labels.count_pixels(5)[0] == std::ranges::count(whole.values, Id{0}));
    const std::vector<Id> numbers = {1, 1, 0, 2, 2};
    labels.renumber(numbers);
    for (Id& label : whole.values)
        if (label != kNone) label = numbers[label];
    check();
    for (const Id label : {0u, 1u, 2u}) {
        CHECK(labels.count_pixels(3)[label] == std::ranges::count(whole.values, label));
        std::int64_t with = 0;
        for (int row = 0; row < 2; ++row)
            for (int column = 0; column < 3; ++column)
                with += std::ranges::count(labels.window(grid.rect(column, row)).values, label) > 0;
        CHECK(labels.count_parts(3)[label] == with);
    }
}

// Merging goes on with the very sums and borders that it would have had.
TEST_CASE("a picture in one part has the regions of segment(), to the bit") {
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
        const Sample s = sample(60, 50, 700, seed % 2 == 0, seed);
        for (const SegmentParams& params : rules()) check_same(s, parts_of(s, 100), params);
    }
}

// No part has more patches than regions may be left of it, and patches end at the lines: then nothing tells
// parts from the whole, if contrasts, smoothed outlines, directions and connected parts reach over the lines
// as they do elsewhere. Parts of 9 pixels are smaller than the squares of contrasts.
TEST_CASE("parts that need no merging have the regions of the whole picture") {
    for (const auto& [step, mask] : {std::pair(9, false), std::pair(40, true)}) {
        INFO("step " << step);
        // Outlines are smoothed in pictures of this size.
        Sample large = rounded(sample(240, 170, 400, mask, 1));
        cut_faces(large, step);
        check_same(large, parts_of(large, step), {});
        Sample small = rounded(sample(101, 67, 120, mask, 2));
        cut_faces(small, step);
        for (const SegmentParams& params : rules()) check_same(small, parts_of(small, step), params);
    }
}

TEST_CASE("flat areas across many parts are found exactly") {
    // 6 stripes, 24 x 4 parts, patches of 2 pixels: merged before parts are joined.
    const auto stripes = [](int, int y) { return 15 * (y / 32); };
    const Sample bands = flat_areas(384, 192, 2, stripes);
    for (const SegmentQuality quality : {SegmentQuality::kFast, SegmentQuality::kDefault}) {
        SegmentParams params;
        params.quality = quality;
        const PartSegmentation found = segment_parts(parts_of(bands, 48), params);
        CHECK(found.count == 6);
        const std::vector<Id> labels = all_labels(found);
        for (std::size_t i = 0; i < labels.size(); ++i) REQUIRE(labels[i] == i / 384 / 32);
    }
    // A board of 4 x 2 squares. Smoothed outlines would round its corners, here as in one piece.
    const auto squares = [](int x, int y) { return 40 + 30 * ((x / 96 + y / 96) % 2); };
    const Sample board = flat_areas(384, 192, 4, squares);
    SegmentParams params;
    params.quality = SegmentQuality::kFast;
    const PartSegmentation found = segment_parts(parts_of(board, 32), params);
    CHECK(found.count == 8);
    const std::vector<Id> labels = all_labels(found);
    for (std::size_t i = 0; i < labels.size(); ++i) REQUIRE(labels[i] == i / 384 / 96 * 4 + i % 384 / 96);
}

// A missing part is as the outside of a mask: what it separates stays apart, all else is joined.
TEST_CASE("parts may be missing") {
    Sample s = flat_areas(120, 40, 2, [](int, int) { return 50; });
    for (std::size_t i = 0; i < s.level.map.size(); ++i)
        if (s.level.map.x_of(i) / 40 == 1) s.level.map.values[i] = {};
    for (SegmentParams params : rules()) {
        params.segments.reset();
        const PartSegmentation found = segment_parts(parts_of(s, 40), params);
        REQUIRE(found.count == 2);
        CHECK(found.labels.count_pixels(2) == std::vector<std::int64_t>{1600, 1600});
    }
    for (PixelCoord& coord : s.level.map.values) coord = {};
    CHECK_THROWS_AS(segment_parts(parts_of(s, 40), {}), Error);
}

TEST_CASE("regions of parts are connected, numbered by their first pixel, and as many as asked for") {
    const Sample s = sample(120, 100, 2500, true, 3);
    for (const std::int64_t wanted : {5, 60, 900}) {
        SegmentParams params;
        params.segments = wanted;
        const PartSegmentation found = segment_parts(parts_of(s, 20), params);
        INFO(wanted << " wanted, " << found.missed);
        CHECK((found.count == as_index(wanted) || !found.missed.empty()));
        const std::vector<Id> labels = all_labels(found);
        const ConnectedParts connected = connected_parts(
            GridSize{120, 100}, [&](std::size_t i) { return labels[i] != kNone; },
            [&](std::size_t i, std::size_t j) { return labels[i] == labels[j]; });
        CHECK(connected.part.values == labels);
    }
}

TEST_CASE("parts are merged to a number of regions that is bounded") {
    CHECK(fine_regions(1e6, 1e6, {}) == 150'000);
    CHECK(fine_regions(1e6, 1e9, {}) == 150);
    CHECK(fine_regions(1e6, 1e11, {}) == 64);
    CHECK(fine_regions(8192, 1e11, {}) == 2);
    CHECK(fine_regions(256, 1e11, {}) == 1);
    SegmentParams params;
    params.segments = 1'000'000;
    CHECK(fine_regions(1e6, 1e9, params) == 4000);
    params.segments = std::numeric_limits<std::int64_t>::max();
    CHECK(fine_regions(1e6, 1e9, params) == 1'000'000);  // its pixels
}

TEST_CASE("parts have the same regions with any number of threads") {
    const Sample s = sample(150, 120, 2000, true, 5);
    std::vector<std::vector<Id>> labels;
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        labels.push_back(all_labels(segment_parts(parts_of(s, 50), {})));
    }
    CHECK(labels[0] == labels[1]);
}
