// Faces and weights from positions on a grid, against the rule of docs/format.md written a second time in the
// simplest way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>

#include "libcore/mesh/locate_map.h"
#include "tests/support/meshes.h"

using namespace imgmesh;

namespace {

__extension__ using Wide = __int128;

// In units of 1/32 pixel.
struct Point {
    std::int64_t x, y;
    auto operator<=>(const Point&) const = default;
};

Point units(const Vec2f& p) {
    return {std::lround(double(p.x()) * 32), std::lround(double(p.y()) * 32)};
}

std::int64_t area2(Point a, Point b, Point c) {
    return (b.y - a.y) * (c.x - a.x) - (b.x - a.x) * (c.y - a.y);
}

// The rule, face by face and with wide integers.
PixelCoord reference(const BaseMesh& mesh, Point p, std::int64_t n) {
    PixelCoord best;
    Point least{};
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const std::array<Point, 3> q = {units(mesh.position[mesh.faces[f][0]]),
                                        units(mesh.position[mesh.faces[f][1]]),
                                        units(mesh.position[mesh.faces[f][2]])};
        const std::int64_t area = area2(q[0], q[1], q[2]);
        const std::array<std::int64_t, 3> side = {area2(q[1], q[2], p), area2(q[2], q[0], p),
                                                  area2(q[0], q[1], p)};
        if (area <= 0 || side[0] < 0 || side[1] < 0 || side[2] < 0) continue;
        // Its corners' sums, y before x.
        const Point sum{q[0].y + q[1].y + q[2].y, q[0].x + q[1].x + q[2].x};
        if (best.face != kNone && least <= sum) continue;
        least = sum;
        std::array<std::int64_t, 3> weight{}, rest{};
        for (std::size_t k = 0; k < 3; ++k) {
            weight[k] = static_cast<std::int64_t>(Wide(side[k]) * n / area);
            rest[k] = static_cast<std::int64_t>(Wide(side[k]) * n % area);
        }
        std::array<std::size_t, 3> order = {0, 1, 2};
        std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
            return std::tuple(-rest[i], q[i].y, q[i].x) < std::tuple(-rest[j], q[j].y, q[j].x);
        });
        const std::int64_t left = n - weight[0] - weight[1] - weight[2];
        for (std::size_t k = 0; k < as_index(left); ++k) ++weight[order[k]];
        best = {as_id(f), static_cast<float>(double(weight[1]) / double(n)),
                static_cast<float>(double(weight[2]) / double(n))};
    }
    return best;
}

std::int64_t steps_of(WeightPrecision precision) {
    return precision == WeightPrecision::kHalf ? 2048 : 1 << 24;
}

// Displacements that keep pixels in the rectangle of a mesh; some on its sides.
Displacements random_displacements(int width, int height, int steps, double most, std::uint32_t seed) {
    std::mt19937 random(seed);
    Displacements d;
    d.width = width;
    d.height = height;
    d.steps = steps;
    const auto moved = [&](int at, int side) {
        const int low = side == 1 ? -steps / 2 : 0, high = side == 1 ? steps / 2 : (side - 1) * steps;
        const int reach = static_cast<int>(most * steps);
        const int by = static_cast<int>(random() % static_cast<unsigned>(2 * reach + 1)) - reach;
        return static_cast<std::int16_t>(std::clamp(at * steps + by, low, high) - at * steps);
    };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            d.dx.push_back(moved(x, width));
            d.dy.push_back(moved(y, height));
        }
    return d;
}

// Every pixel is where the reference has it; returns the map.
PixelMap check_located(const BaseMesh& mesh, const Displacements& d, WeightPrecision precision) {
    const LocatedMap located = locate_map(mesh, d, precision);
    REQUIRE(!located.lost);
    REQUIRE(located.map.size() == d.pixel_count());
    CHECK(located.map.precision == precision);
    int wrong = 0;
    for (std::size_t i = 0; i < d.pixel_count(); ++i) {
        const Point p{d.x_of(i) * 32 + d.dx[i] * (32 / d.steps), d.y_of(i) * 32 + d.dy[i] * (32 / d.steps)};
        const PixelCoord expected =
            d.inside.contains(i) ? reference(mesh, p, steps_of(precision)) : PixelCoord{};
        wrong += located.map[i] != expected;
    }
    CHECK(wrong == 0);
    return located.map;
}

constexpr WeightPrecision kPrecisions[] = {WeightPrecision::kHalf, WeightPrecision::kFloat};

struct Size {
    int width, height;
};

double low(int side) {
    return side == 1 ? -0.5 : 0;
}
double high(int side) {
    return side == 1 ? 0.5 : side - 1;
}

}  // namespace

TEST_CASE("locate_map: the rule, on random meshes, and back") {
    std::uint32_t seed = 0;
    for (const Size& size : {Size{40, 30}, {1, 60}, {60, 1}, {1, 1}, {2, 2}, {90, 7}})
        for (const int cells : {1, 4, 12})
            for (const int steps : {8, 16, 32})
                for (const WeightPrecision precision : kPrecisions) {
                    const int width = size.width, height = size.height;
                    INFO(width << " x " << height << ", " << cells << " cells, " << steps << " steps");
                    const auto count = [&](int side) { return std::clamp(side / 2, 1, cells); };
                    const BaseMesh mesh =
                        test::jittered_grid(low(width), low(height), high(width), high(height), count(width),
                                            count(height), ++seed);
                    const Displacements d = random_displacements(width, height, steps, 1.5, seed);
                    const PixelMap map = check_located(mesh, d, precision);
                    const auto back = displacements_of(mesh, map);
                    REQUIRE(back.has_value());
                    CHECK(back->steps <= steps);
                    // Weights in 1/2048 leave some room for other displacements in the larger faces.
                    for (std::size_t i = 0; precision == WeightPrecision::kFloat && i < map.size(); ++i) {
                        CHECK(back->dx[i] * steps == d.dx[i] * back->steps);
                        CHECK(back->dy[i] * steps == d.dy[i] * back->steps);
                    }
                    CHECK(locate_map(mesh, *back, precision).map.values == map.values);
                }
}
