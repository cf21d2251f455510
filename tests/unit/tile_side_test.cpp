// Sides of tiles: exact where the line is simple, in order everywhere.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "libcore/base/index.h"
#include "libcore/tiles/line_segments.h"
#include "libcore/tiles/line_shifts.h"
#include "libcore/tiles/simplify_side.h"

using namespace imgmesh;

namespace {

// A hat with its top at pixel 20 of 51, in one channel.
std::vector<float> hat() {
    std::vector<float> line;
    for (int i = 0; i <= 50; ++i) line.push_back(static_cast<float>(i < 20 ? i : 20 - (i - 20) * 2 / 3.0));
    return line;
}

std::vector<float> noise(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> line(count);
    for (float& f : line) f = static_cast<float>(random() % 1000) / 10;
    return line;
}

float drawn(const Side& side, float place) {
    std::size_t s = 0;
    while (s + 2 < side.vertices.size() && static_cast<float>(side.vertices[s + 1]) < place) ++s;
    const auto a = static_cast<float>(side.vertices[s]), b = static_cast<float>(side.vertices[s + 1]);
    const float t = (place - a) / (b - a);
    return side.features[s] + t * (side.features[s + 1] - side.features[s]);
}

}  // namespace

TEST_CASE("a line keeps the vertices that it needs") {
    CHECK(line_vertices(hat(), 1, 1) == std::vector<int>{0, 20, 50});
    CHECK(line_vertices(std::vector<float>(30, 5.0f), 1, 0) == std::vector<int>{0, 29});
    CHECK(line_vertices(std::vector<float>{7}, 1, 9) == std::vector<int>{0});
    CHECK(line_vertices(std::vector<float>{7, 8}, 1, 9) == std::vector<int>{0, 1});
}

TEST_CASE("the higher the threshold, the fewer vertices a line keeps") {
    const std::vector<float> line = noise(3 * 300, 1);
    std::size_t before = 301;
    for (const double threshold : {0.0, 1e3, 1e4, 1e5, 1e9}) {
        const std::size_t count = line_vertices(line, 3, threshold).size();
        CHECK(count <= before);
        before = count;
    }
    CHECK(before == 2);
}

TEST_CASE("vertices are counted for many thresholds at once") {
    const std::vector<float> line = noise(3 * 300, 2);
    const std::vector<double> thresholds{0, 1e4, 1e5, 3e5, 1e6, 1e7, 1e12};
    const std::vector<int> counts = line_vertex_counts(line, 3, thresholds);
    REQUIRE(counts.size() == thresholds.size());
    for (std::size_t i = 0; i < counts.size(); ++i)
        CHECK((counts[i] == as_int(line_vertices(line, 3, thresholds[i]).size())));
}

TEST_CASE("a side's features are those of the line where vertices suffice") {
    const Side side = simplify_side(hat(), 1, {.threshold = 1});
    REQUIRE(side.vertices.size() == 3);
    const float truth[] = {0, 20, 0};
    for (std::size_t v = 0; v < 3; ++v) CHECK(std::abs(side.features[v] - truth[v]) < 1e-4f);
    for (const float shift : side.shifts) CHECK(shift == 0);
}

TEST_CASE("pixels of a side keep their order and lower the error") {
    for (unsigned seed = 0; seed < 5; ++seed) {
        const std::vector<float> line = noise(200, seed);
        const Side moved = simplify_side(line, 1, {.threshold = 1.6e5});
        const Side rests = simplify_side(line, 1, {.threshold = 1.6e5, .smoothness = 0});
        CHECK(moved.vertices == rests.vertices);
        CHECK(rests.shifts.empty());
        REQUIRE(moved.shifts.size() == 200);
        CHECK((moved.shifts.front() == 0 && moved.shifts.back() == 0));
        double error = 0, resting = 0;
        for (std::size_t i = 0; i < 200; ++i) {
            const float place = static_cast<float>(i) + moved.shifts[i];
            if (i > 0) CHECK(place - (static_cast<float>(i) - 1 + moved.shifts[i - 1]) >= 1.0f / kShiftSteps);
            CHECK(std::abs(moved.shifts[i]) < 1);
            error += std::pow(drawn(moved, place) - line[i], 2);
            resting += std::pow(drawn(rests, static_cast<float>(i)) - line[i], 2);
        }
        CHECK(error < resting);
    }
}

TEST_CASE("a step moves its pixels to its ends") {
    // Black to white within one pixel, while the vertices are three pixels apart.
    std::vector<float> line(10, 0.0f);
    for (std::size_t i = 5; i < 10; ++i) line[i] = 100;
    const std::vector<int> vertices{0, 3, 6, 9};
    const std::vector<float> colors{0, 0, 100, 100};
    const std::vector<int> shifts = line_shifts(line, 1, vertices, colors, 1);
    CHECK(shifts[4] == -kMostShift);
    CHECK(shifts[5] == kMostShift);
}

TEST_CASE("a coarser side has half of the vertices, in their places") {
    const Side side = simplify_side(noise(101, 7), 1, {.threshold = 3.2e4});
    const Side coarse = coarser_side(side, 1);
    CHECK(coarse.vertices.size() == side.vertices.size() / 2 + 1);
    CHECK((coarse.vertices.front() == 0 && coarse.vertices.back() == 100));
    CHECK(std::ranges::includes(side.vertices, coarse.vertices));
    CHECK(
        (coarse.features.front() == side.features.front() && coarse.features.back() == side.features.back()));
    CHECK(coarse.features.size() == coarse.vertices.size());
    CHECK(coarse.shifts.empty());
}

TEST_CASE("the ends of a side keep the colours of their pixels, as four tiles meet there") {
    const std::vector<float> line = noise(60, 3);
    for (const double threshold : {1e3, 1e9}) {
        const Side side = simplify_side(line, 1, {.threshold = threshold});
        CHECK((side.features.front() == line.front() && side.features.back() == line.back()));
    }
}
