// Regions of two tiles become one by their colours or by what they have in common on the line.
#include "libcore/segment/join_regions.h"

#include <doctest/doctest.h>

using namespace imgmesh;

namespace {

TileRegion region(float lightness, std::int64_t pixels, std::int64_t first) {
    return {Vec3f(lightness, 0, 0), pixels, first};
}

}  // namespace

TEST_CASE("regions of alike colours that meet become one, others stay apart") {
    RegionJoiner joiner(5);
    const TileRegion left[] = {region(10, 100, 0), region(90, 50, 3)};
    const TileRegion right[] = {region(12, 80, 8), region(50, 70, 9)};
    CHECK(joiner.add(left) == 0);
    CHECK(joiner.add(right) == 2);
    // The first of the left meets both of the right, the second a small part of the last.
    const std::vector<Id> a{0, 0, 0, 0, 1, 1}, b{2, 2, 3, 3, 3, kNone};
    joiner.add_line(a, b);
    const JoinedRegions joined = joiner.finish();
    CHECK(joined.numbers == std::vector<Id>{0, 1, 0, 2});
    CHECK(joined.pixels == std::vector<std::int64_t>{180, 50, 70});
    CHECK(joined.across == 1);
}

TEST_CASE("regions that have most of the line in common become one whatever their colours") {
    RegionJoiner joiner(1);
    const TileRegion left[] = {region(10, 100, 0)}, right[] = {region(80, 60, 4)};
    joiner.add(left);
    joiner.add(right);
    const std::vector<Id> a{0, 0, 0}, b{1, 1, kNone};
    joiner.add_line(a, b);
    CHECK(joiner.finish().pixels == std::vector<std::int64_t>{160});
}
