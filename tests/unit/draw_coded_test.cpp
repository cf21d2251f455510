// The decoder's drawing against real numbers and against pictures known by hand.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "tests/support/coded_shapes.h"

using namespace imgmesh;
using namespace imgmesh::coding;

namespace {

constexpr std::array<std::array<int, 2>, 6> kSizes = {{{1, 1}, {1, 9}, {9, 1}, {2, 2}, {31, 17}, {40, 64}}};

struct Point {
    double x, y;
};
double cross(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The colour, in grey levels, of the last face at a pixel of the mesh's own size.
double exact(const CodedShape& shape, const std::vector<std::int32_t>& color, int x, int y) {
    const Point at{4.0 * x, 4.0 * y};
    double out = -1;
    for (const Face& f : shape.faces) {
        std::array<Point, 3> p;
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = {static_cast<double>(shape.grid.x(shape.point[f[i]][0])),
                    static_cast<double>(shape.grid.y(shape.point[f[i]][1]))};
        const double area = cross(p[0], p[1], p[2]), a = cross(p[1], p[2], at), b = cross(p[2], p[0], at),
                     c = cross(p[0], p[1], at);
        if (a < 0 || b < 0 || c < 0) continue;
        out = (a * color[f[0]] + b * color[f[1]] + c * color[f[2]]) / area / kColorUnit;
    }
    return out;
}

}  // namespace

TEST_CASE("a constant colour fills every pixel at any size") {
    std::mt19937 random(1);
    for (const auto& [width, height] : kSizes)
        for (const int step : {1, 3, 4, 16}) {
            const CrossedLines lines({width, height, step}, 6, random);
            for (int channels = 1; channels <= 4; ++channels) {
                const std::size_t depth = as_index(channels);
                std::vector<std::int32_t> color(lines.point.size() * depth, 77 * kColorUnit);
                if (channels % 2 == 0)
                    for (std::size_t i = depth - 1; i < color.size(); i += depth) color[i] = 255 * kColorUnit;
                for (const auto& [across, down] : {std::array{width, height},
                                                   {2 * width, 2 * height},
                                                   {(width + 1) / 2, (height + 1) / 2}}) {
                    const auto out = draw_coded(lines.shape(), color, channels, across, down);
                    REQUIRE(out.size() == as_index(across * down) * depth);
                    for (std::size_t i = 0; i < out.size(); ++i)
                        REQUIRE(out[i] == (channels % 2 == 0 && i % depth == depth - 1 ? 255 : 77));
                }
            }
        }
}

TEST_CASE("the drawing is that of real numbers, rounded") {
    std::mt19937 random(2);
    for (const auto& [width, height] : kSizes)
        for (const int step : {1, 3, 7}) {
            const CrossedLines lines({width, height, step}, 9, random);
            std::vector<std::int32_t> color;
            for (std::size_t i = 0; i < lines.point.size(); ++i)
                color.push_back(static_cast<std::int32_t>(random() % (400 * kColorUnit)) - 70 * kColorUnit);
            const auto out = draw_coded(lines.shape(), color, 1, width, height);
            for (int y = 0; y < height; ++y)
                for (int x = 0; x < width; ++x) {
                    const double real = std::clamp(exact(lines.shape(), color, x, y), 0.0, 255.0);
                    REQUIRE(std::abs(out[as_index(y * width + x)] - real) < 0.51);
                }
        }
}

// The slope of this face is 2^17 grey levels a pixel and does not fit into 32 bits, but its one pixel does.
TEST_CASE("the steepest face wraps around to the right colour") {
    const CodedGrid grid{60000, 2, 1};
    const std::vector<GridPoint> point{{0, 0}, {239996, 0}, {239995, 4}, {0, 4}, {239996, 4}};
    const std::vector<Face> faces{{0, 1, 3}, {3, 1, 2}, {2, 1, 4}};
    const std::vector<std::int32_t> color{0, 200 * kColorUnit, 0, 100 * kColorUnit, 250 * kColorUnit};
    const auto out = draw_coded({grid, point, faces}, color, 1, 60000, 2);
    CHECK(out[0] == 0);
    CHECK(out[59999] == 200);
    CHECK(out[60000] == 100);
    CHECK(out[119999] == 250);
    CHECK(out[30000] == 100);
}

// Pixel X of twice the size lies at (X + 1/2) / 2 - 1/2 of the image; the outermost quarter is the border's.
TEST_CASE("a ramp keeps its places at twice the size") {
    const CodedGrid grid{11, 3, 4};
    const std::vector<GridPoint> point{{0, 0}, {10, 0}, {0, 2}, {10, 2}};
    const std::vector<Face> faces{{0, 1, 2}, {1, 3, 2}};
    const std::vector<std::int32_t> color{0, 200 * kColorUnit, 0, 200 * kColorUnit};
    const auto out = draw_coded({grid, point, faces}, color, 1, 22, 6);
    for (std::size_t y = 0; y < 6; ++y)
        for (std::size_t x = 0; x < 22; ++x) {
            const double at = (static_cast<double>(x) + 0.5) / 2 - 0.5;
            CHECK(std::abs(out[y * 22 + x] - 20 * std::clamp(at, 0.0, 10.0)) < 6);
        }
    CHECK(out[0] == 0);
    CHECK(out[21] == 200);
}

TEST_CASE("pixels are divided by their alpha") {
    const CodedGrid grid{3, 3, 4};
    const std::vector<GridPoint> point{{0, 0}, {2, 0}, {0, 2}, {2, 2}};
    const std::vector<Face> faces{{0, 1, 2}, {1, 3, 2}};
    const auto at = [](int level) { return level * kColorUnit; };
    // Opaque 200 at the top, nothing at the bottom; premultiplied 200 fades with alpha.
    const std::vector<std::int32_t> color{at(200), at(255), at(200), at(255), 0, 0, 0, 0};
    const auto out = draw_coded({grid, point, faces}, color, 2, 3, 3);
    for (std::size_t x = 0; x < 3; ++x) {
        CHECK(out[2 * x] == 200);
        CHECK(out[2 * x + 1] == 255);
        CHECK(out[2 * (3 + x)] == 200);
        CHECK(out[2 * (3 + x) + 1] == 128);
        CHECK(out[2 * (6 + x)] == 0);
        CHECK(out[2 * (6 + x) + 1] == 0);
    }
}
