// Colours of regions: no two alike, and neighbours far apart.
#include <doctest/doctest.h>

#include <limits>
#include <random>
#include <set>

#include "libcore/image/color.h"
#include "libcore/segment/region_colors.h"

using namespace imgmesh;

namespace {

float distance(const RgbCode& a, const RgbCode& b) {
    const auto luv = [](const RgbCode& c) {
        return luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, Vec3f(c[0], c[1], c[2]) / 255));
    };
    return (luv(a) - luv(b)).norm();
}

// Random pairs are neighbours, and region 0 is everybody's, as a background is.
std::vector<RegionFacts> random_map(std::size_t regions, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::vector<RegionFacts> facts(regions);
    const auto join = [&](std::size_t a, std::size_t b) {
        facts[a].neighbors.emplace_back(Id(b), 1);
        facts[b].neighbors.emplace_back(Id(a), 1);
    };
    for (std::size_t r = 1; r < regions; ++r) join(0, r);
    for (std::size_t k = 0; k < 3 * regions; ++k) {
        const std::size_t a = random() % regions, b = random() % regions;
        if (a != b) join(a, b);
    }
    return facts;
}

}  // namespace

TEST_CASE("colours of regions: all different, neighbours clearly, and the same each time") {
    for (const std::size_t regions : {1u, 2u, 20u, 2000u}) {
        const std::vector<RegionFacts> facts = random_map(regions, 3);
        const std::vector<RgbCode> colors = distinct_colors(facts);
        REQUIRE(colors.size() == regions);
        CHECK(std::set<RgbCode>(colors.begin(), colors.end()).size() == regions);
        float least = std::numeric_limits<float>::max();
        for (std::size_t r = 0; r < regions; ++r)
            for (const auto& [other, length] : facts[r].neighbors)
                least = std::min(least, distance(colors[r], colors[other]));
        CHECK(least > 50);  // a step of 1 is just seen
        CHECK(colors == distinct_colors(facts));
    }
    const std::vector<RgbCode> many = distinct_colors(random_map(20'000, 1));
    CHECK(std::set<RgbCode>(many.begin(), many.end()).size() == many.size());
}

TEST_CASE("colours of regions: the drawing has their codes, and alpha with a mask only") {
    const std::vector<RgbCode> colors = {{10, 20, 30}, {255, 0, 128}};
    const Image all = draw_colors({{2, 1, {1, 0}}, 2}, colors);
    CHECK(all.channels == 3);
    CHECK(all.data == std::vector<float>{1, 0, 128.0f / 255, 10.0f / 255, 20.0f / 255, 30.0f / 255});
    const Image masked = draw_colors({{2, 1, {kNone, 1}}, 2}, colors);
    CHECK(masked.channel_names.back() == "A");
    CHECK(masked.data == std::vector<float>{0, 0, 0, 0, 1, 0, 128.0f / 255, 1});
}
