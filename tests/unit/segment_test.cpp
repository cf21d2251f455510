// Segmentation: what can be computed by hand.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/segment/draw_regions.h"
#include "libcore/segment/pair_contrasts.h"
#include "libcore/segment/region_distance.h"
#include "libcore/segment/region_faces.h"
#include "libcore/segment/segment.h"
#include "tests/support/random_mesh_image.h"
#include "tests/support/segment_maps.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

SegmentParams by_threshold(DistanceRule rule, double threshold) {
    SegmentParams params;
    params.distance = rule;
    params.threshold = threshold;
    return params;
}

}  // namespace

// Patch 5 lies in two parts that touch at a corner only, which is no connection.
TEST_CASE("cells: the connected parts of patches, numbered by their first pixel") {
    const PixelMap map = map_of_faces(3, 3,
                                      {7, 7, 5,      //
                                       7, 5, kNone,  //
                                       5, 5, 7});
    const Cells cells = cut_cells(map);
    CHECK(cells.values == std::vector<Id>{0, 0, 1, 0, 2, kNone, 2, 2, 3});
    CHECK(cells.face == std::vector<Id>{7, 5, 5, 7});
}

// A ring whose arms meet only in its last row: their trees of pixels are joined late.
TEST_CASE("cells: arms that meet below are one cell") {
    const Cells cells = cut_cells(map_of_faces(3, 3, {1, 2, 1, 1, 2, 1, 1, 1, 1}));
    CHECK(cells.values == std::vector<Id>{0, 1, 0, 0, 1, 0, 0, 0, 0});
}

// The pixel in the middle has weights of one third each, the others lie at their face's corners and edges.
TEST_CASE("paper: a patch's colour is weighted by the least weight") {
    PixelMap map = map_of_faces(4, 1, {0, 0, 1, 1});
    map[0] = {0, 0.25f, 0.25f};  // least 1/4
    map[1] = {0, 0.5f, 0.375f};  // least 1/8
    map[2] = {1, 0.5f, 0.5f};    // least 0: this patch counts all of its pixels alike
    map[3] = {1, 1, 0};
    const FeatureImage picture{4, 1, 3, {30, 0, 0, 60, 9, 0, 10, 0, 4, 20, 0, 8}};
    const RegionGraph graph = region_graph(cut_cells(map), map, picture, {});
    CHECK((graph.regions[0].paper_color() - Vec3d(40, 3, 0)).norm() < 1e-9);
    CHECK((graph.regions[1].paper_color() - Vec3d(15, 0, 6)).norm() < 1e-9);
    CHECK(paper_distance()(graph.regions[0], graph.regions[1], graph.borders[0]) ==
          doctest::Approx(std::sqrt(25 * 25 + 9 + 36)));
}

// Grey steps 0, 4, 10, 20 in a row. 0 and 4 merge first and become 2, so 10 is 8 away from them, not 6. Then
// the three are 14/3, and 20 is 15.33 away.
TEST_CASE("paper: closest first, colours averaged anew, strictly below the threshold") {
    const PixelMap map = map_of_faces(4, 1, {0, 1, 2, 3});
    const FeatureImage picture{4, 1, 3, {0, 0, 0, 4, 0, 0, 10, 0, 0, 20, 0, 0}};
    const auto regions = [&](double threshold) {
        return segment(level_of(map), picture, by_threshold(DistanceRule::kPaper, threshold)).labels.values;
    };
    CHECK(regions(4) == std::vector<Id>{0, 1, 2, 3});
    CHECK(regions(4.01) == std::vector<Id>{0, 0, 1, 2});
    CHECK(regions(8) == std::vector<Id>{0, 0, 1, 2});
    CHECK(regions(8.01) == std::vector<Id>{0, 0, 0, 1});
    CHECK(regions(15.3) == std::vector<Id>{0, 0, 0, 1});
    CHECK(regions(15.4) == std::vector<Id>{0, 0, 0, 0});
}

// Heights 0, 1, 2, 4, 4.5, 9: from 1 to 2, from 2 to 4 and from 4.5 to 9 the threshold can double. Between 3
// and 6 it moves by the factor 4/3 below 4 and above 4.5.
TEST_CASE("clearest merges: where the threshold can move farthest") {
    Hierarchy hierarchy{7, {}, 0};
    for (const float height : {0.0f, 1.0f, 2.0f, 4.0f, 4.5f, 9.0f})
        hierarchy.merges.push_back({0, 1, height});
    CHECK(clearest_merges(hierarchy, 1, 10) == 2);
    CHECK(clearest_merges(hierarchy, 1.5, 10) == 3);
    CHECK(clearest_merges(hierarchy, 3, 6) == 3);
    CHECK(clearest_merges(hierarchy, 3.1, 6) == 5);
    CHECK(clearest_merges(hierarchy, 4.1, 4.2) == 4);
    CHECK(clearest_merges(hierarchy, 20, 30) == 6);
    CHECK(clearest_merges(hierarchy, 0.1, 0.5) == 1);
    CHECK(clearest_merges({1, {}, 0}, 1, 2) == 0);
}

// All steps are equal: among equal distances the lower regions merge first.
TEST_CASE("ties go to the lower regions") {
    const PixelMap map = map_of_faces(4, 1, {3, 2, 1, 0});
    const FeatureImage picture{4, 1, 3, {0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0}};
    SegmentParams params = by_threshold(DistanceRule::kPaper, 1);
    params.segments = 3;
    CHECK(segment(level_of(map), picture, params).labels.values == std::vector<Id>{0, 0, 1, 2});
}

TEST_CASE("population distance: the textbook's values") {
    const Vec3d zero = Vec3d::Zero(), step(3, 4, 0);
    CHECK(population_distance(zero, zero, zero, zero) == 0.0);
    // Equal spreads s: |step|^2 / 8 s^2.
    CHECK(population_distance(zero, zero, step, zero) ==
          doctest::Approx(25 / (8 * kUniformDeviation * kUniformDeviation)));
    // Equal means, variances in the ratio 4 in one channel: ln((1 + 4)^2 / (4 * 4)) / 4.
    const Vec3d wide(3 * kUniformDeviation * kUniformDeviation, 0, 0);
    CHECK(population_distance(step, zero, step, wide) == doctest::Approx(std::log(25.0 / 16) / 4));
    CHECK(color_equivalent(population_distance(zero, zero, step, zero)) == doctest::Approx(5));
}

// Two uniform halves of a square image: every part of the formula then gives their colours' distance, and so
// does the height of the merge.
TEST_CASE("contour distance of two plain halves is that of their colours") {
    constexpr int kSide = 32;
    PixelMap map = map_of_faces(kSide, kSide, std::vector<Id>(kSide * kSide, 0));
    FeatureImage picture{kSide, kSide, 3, std::vector<float>(3 * kSide * kSide, 50.0f)};
    for (int y = 0; y < kSide; ++y)
        for (int x = kSide / 2; x < kSide; ++x) {
            const auto i = static_cast<std::size_t>(y * kSide + x);
            map[i].face = 1;
            picture.data[3 * i] = 53;
            picture.data[3 * i + 1] = 54;
        }
    const Cells cells = cut_cells(map);
    const PairContrasts contrasts = pair_contrasts(picture, cells);
    CHECK(double(contrasts.right[kSide / 2 - 1]) ==
          doctest::Approx(1 - std::exp(-25 / (8 * kUniformDeviation * kUniformDeviation))));
    const RegionGraph graph = region_graph(cells, map, picture, contrasts);
    REQUIRE(graph.borders.size() == 1);
    CHECK(graph.borders[0].length == kSide);
    CHECK(contour_distance(kSide * kSide)(graph.regions[0], graph.regions[1], graph.borders[0]) ==
          doctest::Approx(1 - std::exp(-25 / (8 * kUniformDeviation * kUniformDeviation))).epsilon(1e-4));
    SegmentParams params;
    params.quality = SegmentQuality::kFast;
    const Segmentation result = segment(level_of(map), picture, params);
    CHECK(result.hierarchy.merges.at(0).height == doctest::Approx(5).epsilon(1e-4));
}

// Pixels outside the mask have colours too, but do not count.
TEST_CASE("contrasts see nothing outside the mask") {
    const PixelMap map = map_of_faces(6, 1, {0, 0, 0, 1, 1, kNone});
    FeatureImage picture{6, 1, 3, std::vector<float>(18, 10.0f)};
    picture.data[15] = 1000;
    const PairContrasts contrasts = pair_contrasts(picture, cut_cells(map));
    CHECK(contrasts.right[2] == 0.0f);
    CHECK(contrasts.right[4] == 0.0f);
}

// A speck of one pixel, far from everything, in a ground of two halves that are close to each other.
TEST_CASE("min size: small regions go to their closest neighbour first") {
    const PixelMap map = map_of_faces(7, 1, {0, 0, 0, 1, 2, 2, 2});
    FeatureImage picture{7, 1, 3, std::vector<float>(21, 0.0f)};
    picture.data[9] = 90;
    for (std::size_t x = 4; x < 7; ++x) picture.data[3 * x] = 1;
    SegmentParams params = by_threshold(DistanceRule::kPaper, 0.5);
    CHECK(segment(level_of(map), picture, params).labels.count == 3);
    params.min_size = 2;
    const Segmentation result = segment(level_of(map), picture, params);
    CHECK(result.labels.values == std::vector<Id>{0, 0, 0, 1, 1, 1, 1});
    CHECK(result.hierarchy.forced == 1);
    params.segments = 3;
    const Segmentation most = segment(level_of(map), picture, params);
    CHECK(most.labels.count == 2);
    CHECK(most.missed.starts_with("3 regions were wanted, at most 2 of that size can be had from 3"));
}

// An island smaller than the least size has no neighbour to merge with.
TEST_CASE("islands of a mask stay apart") {
    const PixelMap map = map_of_faces(5, 1, {0, 0, kNone, 0, 1});
    const FeatureImage picture{5, 1, 3, std::vector<float>(15, 0.0f)};
    SegmentParams params = by_threshold(DistanceRule::kContour, 1e9);
    params.min_size = 100;
    CHECK(segment(level_of(map), picture, params).labels.values == std::vector<Id>{0, 0, kNone, 1, 1});
}

TEST_CASE("facts of regions") {
    const PixelMap map = map_of_faces(3, 2, {0, 0, 1, kNone, 0, 1});
    const FeatureImage picture{3, 2, 3, {10, 0, 0, 20, 0, 0, 50, 0, 0, 99, 9, 9, 30, 3, 0, 70, 0, 2}};
    SegmentParams params;
    params.segments = 2;
    const LabelImage labels = segment(level_of(map), picture, params).labels;
    const std::vector<RegionFacts> facts = region_facts(labels, picture);
    REQUIRE(facts.size() == 2);
    CHECK(facts[0].pixels == 3);
    CHECK(facts[0].color == Vec3f(20, 1, 0));
    CHECK(facts[0].box == std::array<int, 4>{0, 0, 1, 1});
    CHECK(facts[1].box == std::array<int, 4>{2, 0, 2, 1});
    CHECK(facts[1].color == Vec3f(60, 0, 1));
    CHECK(facts[0].neighbors == std::vector<std::pair<Id, std::int64_t>>{{1, 2}});
    CHECK(facts[1].neighbors == std::vector<std::pair<Id, std::int64_t>>{{0, 2}});
}

// Squares of a checkerboard of 4x4 pixels, each pixel a patch: that many superpixels are the squares, but for
// a few corners, and of a constant image they have about the same size.
TEST_CASE("superpixels follow edges, and without edges are of similar size") {
    constexpr int kSide = 32;
    std::vector<Id> faces(kSide * kSide);
    for (Id i = 0; i < faces.size(); ++i) faces[i] = i;
    const Level level = level_of(map_of_faces(kSide, kSide, faces));
    FeatureImage picture{kSide, kSide, 3, std::vector<float>(3 * kSide * kSide, 50.0f)};
    SegmentParams params;
    params.superpixels = 64;
    std::vector<std::int64_t> sizes(64, 0);
    for (const Id label : segment(level, picture, params).labels.values) ++sizes[label];
    CHECK(*std::min_element(sizes.begin(), sizes.end()) >= 6);
    CHECK(*std::max_element(sizes.begin(), sizes.end()) <= 40);

    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            if ((x / 4 + y / 4) % 2 == 0) picture.data[static_cast<std::size_t>(3 * (y * kSide + x))] = 80;
    const LabelImage labels = segment(level, picture, params).labels;
    int others = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) others += labels.at(x, y) != Id(y / 4 * 8 + x / 4);
    CHECK(others <= 4);  // corners may be rounded
}

TEST_CASE("a face's region is that of most of its pixels, or its neighbour's") {
    // A strip of four triangles; the third has no pixel, the fourth's are two of region 1 and one of 0.
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 2}, {2, 0}, {2, 2}, {4, 0}, {4, 2}};
    mesh.faces = {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}};
    const PixelMap map = map_of_faces(5, 1, {0, 1, 3, 3, 3});
    const LabelImage labels({5, 1, {0, 0, 0, 1, 1}}, 2);
    CHECK(region_of_faces(mesh, map, labels) == std::vector<Id>{0, 0, 0, 1});
    const LabelImage none({5, 1, std::vector<Id>(5, kNone)}, 0);
    CHECK(region_of_faces(mesh, map_of_faces(5, 1, std::vector<Id>(5, kNone)), none) ==
          std::vector<Id>(4, kNone));
}

TEST_CASE("drawings: lines on the pixels before a border, alpha where there is a mask") {
    const LabelImage labels({3, 1, {0, 0, 1}}, 2);
    const FeatureImage picture{3, 1, 3, {0, 0, 0, 0, 0, 0, 100, 0, 0}};
    SourceInfo source;
    source.width = 3;
    source.height = 1;
    const Image lines = draw_outlines(labels, picture, source);
    CHECK(lines.channels == 3);
    CHECK(lines.pixel(0, 0)[0] < 0.01f);
    CHECK(lines.pixel(1, 0)[0] > 0.9f);  // yellow
    CHECK(lines.pixel(1, 0)[2] < 0.3f);
    CHECK(lines.pixel(2, 0)[2] > 0.99f);
    const Image flat = draw_flat({{3, 1, {0, kNone, 0}}, 1}, {Vec3f(100, 0, 0)}, source);
    REQUIRE(flat.channels == 4);
    CHECK(flat.pixel(0, 0)[1] > 0.99f);
    CHECK(flat.pixel(0, 0)[3] == 1.0f);
    CHECK(flat.pixel(1, 0)[3] == 0.0f);
}

TEST_CASE("a number of regions that cannot be had is as near as possible, and told") {
    const Level level = level_of(map_of_faces(5, 1, {0, 1, kNone, 2, 3}));
    const FeatureImage picture{5, 1, 3, std::vector<float>(15, 1.0f)};
    const auto segmented = [&](std::int64_t number, bool superpixels) {
        SegmentParams params;
        (superpixels ? params.superpixels : params.segments) = number;
        return segment(level, picture, params);
    };
    for (const bool superpixels : {false, true}) {
        CHECK(segmented(5, superpixels).labels.count == 4);
        CHECK(segmented(5, superpixels)
                  .missed.starts_with(superpixels
                                          ? "5 regions were wanted, at most 4 can be had from 4 pixels"
                                          : "5 regions were wanted, at most 4 can be had from 4 connected"));
        CHECK(segmented(1, superpixels).labels.count == 2);
        CHECK(segmented(1, superpixels).missed ==
              "1 region was wanted, 2 are the fewest: so many islands has the mask");
        for (const std::int64_t number : {2, 3, 4}) {
            CHECK(segmented(number, superpixels).labels.count == as_index(number));
            CHECK(segmented(number, superpixels).missed.empty());
        }
    }
}

TEST_CASE("parameters out of range") {
    const Level level = level_of(map_of_faces(2, 1, {0, 1}));
    const FeatureImage picture{2, 1, 3, std::vector<float>(6, 1.0f)};
    const auto refused = [&](auto change) {
        SegmentParams params;
        change(params);
        CHECK_THROWS_AS(segment(level, picture, params), Error);
    };
    refused([](SegmentParams& p) { p.threshold = 0; });
    refused([](SegmentParams& p) { p.threshold = std::nan(""); });
    refused([](SegmentParams& p) { p.segments = 0; });
    refused([](SegmentParams& p) { p.superpixels = 0; });
    refused([](SegmentParams& p) { p.segments = p.superpixels = 1; });
    refused([](SegmentParams& p) { p.segments = 1, p.clearest = true; });
    refused([](SegmentParams& p) { p.compactness = -1; });
    refused([](SegmentParams& p) { p.min_size = 0; });
    CHECK_THROWS_AS(segment(level, {1, 1, 3, {1, 1, 1}}, {}), Error);
    CHECK_THROWS_AS(segment(level_of(map_of_faces(2, 1, {kNone, kNone})), picture, {}), Error);
}
