// Faces and weights from positions on a grid, against the rule of docs/format.md written a second time in the
// simplest way.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/mesh/locate_map.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/meshes.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

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
                    CHECK(displacements_of(mesh, map, &d) == back);
                    // Weights in 1/2048 leave some room for other displacements in the larger faces.
                    for (std::size_t i = 0; precision == WeightPrecision::kFloat && i < map.size(); ++i) {
                        CHECK(back->dx[i] * steps == d.dx[i] * back->steps);
                        CHECK(back->dy[i] * steps == d.dy[i] * back->steps);
                    }
                    CHECK(locate_map(mesh, *back, precision).map.values == map.values);
                }
}

// All pixels at rest lie on vertices and edges.
TEST_CASE("locate_map: a mesh of whole pixels, where every place is a tie") {
    BaseMesh mesh = test::jittered_grid(0, 0, 24, 18, 24, 18, 5);
    for (Vec2f& p : mesh.position) p = {std::round(p.x()), std::round(p.y())};
    for (const int steps : {8, 32})
        for (const WeightPrecision precision : kPrecisions) {
            check_located(mesh, random_displacements(25, 19, steps, 0, 1), precision);
            check_located(mesh, random_displacements(25, 19, steps, 0.1, 1), precision);
        }
}

// Draco renumbers vertices and faces and rotates corners.
TEST_CASE("locate_map: numbers of vertices, faces and corners do not matter") {
    std::mt19937 random(3);
    for (std::uint32_t seed = 1; seed <= 20; ++seed) {
        BaseMesh mesh = test::jittered_grid(0, 0, 30, 22, 10, 11, seed);
        // Many corners on whole pixels: more ties.
        if (seed % 2)
            for (Vec2f& p : mesh.position) p = {std::round(p.x()), std::round(p.y())};
        const Displacements d = random_displacements(31, 23, 8, 0.2, seed);
        for (const WeightPrecision precision : kPrecisions) {
            const PixelMap map = check_located(mesh, d, precision);
            std::vector<Id> vertex(mesh.vertex_count()), face(mesh.faces.size());
            std::iota(vertex.begin(), vertex.end(), 0u);
            std::iota(face.begin(), face.end(), 0u);
            std::shuffle(vertex.begin(), vertex.end(), random);
            std::shuffle(face.begin(), face.end(), random);
            BaseMesh other = mesh;
            std::vector<std::size_t> turn(face.size());
            for (Id v = 0; v < vertex.size(); ++v) other.position[vertex[v]] = mesh.position[v];
            for (Id f = 0; f < face.size(); ++f) {
                turn[f] = random() % 3;
                for (std::size_t k = 0; k < 3; ++k)
                    other.faces[face[f]][k] = vertex[mesh.faces[f][(k + turn[f]) % 3]];
            }
            const PixelMap moved = check_located(other, d, precision);
            int wrong = 0;
            for (std::size_t i = 0; i < map.size(); ++i) {
                const PixelCoord& at = map[i];
                const float weight[3] = {1 - at.u - at.v, at.u, at.v};
                const std::size_t t = turn[at.face];
                wrong += moved[i] != PixelCoord{face[at.face], weight[(1 + t) % 3], weight[(2 + t) % 3]};
            }
            CHECK(wrong == 0);
        }
    }
}

// 2^-24 of such a face has 70 bits.
TEST_CASE("locate_map: faces as large as an image may be") {
    constexpr float kFar = 131071;
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, kFar}, {kFar, kFar}, {kFar, 0}};
    mesh.feature.assign(12, 0);
    mesh.faces = {{0, 1, 2}, {2, 3, 0}};
    Displacements d = random_displacements(131072, 1, 8, 3, 1);
    for (std::size_t i = 0; i < d.dy.size(); ++i) d.dy[i] = static_cast<std::int16_t>(i * 7919 % 32768);
    // One row of a square image: from the diagonal to 4096 pixels below.
    for (const WeightPrecision precision : kPrecisions) check_located(mesh, d, precision);
    const PixelMap map = locate_map(mesh, d, WeightPrecision::kFloat).map;
    const auto back = displacements_of(mesh, map);
    REQUIRE(back.has_value());
    CHECK(*back == d);
    // Mesh corners as far as positions go, in all directions.
    mesh.position = {{-kFar, -kFar}, {-kFar, kFar}, {kFar, kFar}, {kFar, -kFar}};
    check_located(mesh, d, WeightPrecision::kFloat);
}

// The outermost bins hold all that is beyond the image, and faces are larger than bins.
TEST_CASE("locate_map: positions beyond the image") {
    const BaseMesh mesh = test::jittered_grid(-50, -40, 90, 70, 12, 12, 1);
    Displacements d = random_displacements(40, 30, 16, 0, 1);
    std::mt19937 random(1);
    for (std::size_t i = 0; i < d.pixel_count(); ++i) {
        d.dx[i] = static_cast<std::int16_t>(static_cast<int>(random() % 1600) - 800);
        d.dy[i] = static_cast<std::int16_t>(static_cast<int>(random() % 1280) - 640);
    }
    const PixelMap map = check_located(mesh, d, WeightPrecision::kFloat);
    CHECK(displacements_of(mesh, map) == d);
}

// Strips one pixel wide, pinches, holes, islands: pixels at rest are often on the boundary, and two vertices
// at one place.
TEST_CASE("locate_map: masked images") {
    for (const test::NamedMask& sample : test::sample_masks(24)) {
        INFO(sample.name);
        const Mask& mask = sample.mask;
        const FeatureImage feature = test::sample_feature(test::Kind::kNoise, mask.width, mask.height);
        const BaseMesh mesh = simplify(grid_mesh(feature, mask), test::plain_params(), {.vertices = 80}).mesh;
        Displacements d = random_displacements(mask.width, mask.height, 16, 0, 1);
        d.inside = mask;
        for (const WeightPrecision precision : kPrecisions) {
            const PixelMap map = check_located(mesh, d, precision);
            const auto back = displacements_of(mesh, map);
            REQUIRE(back.has_value());
            CHECK(back->steps == 8);
            CHECK(back->inside.empty() == (mask.count() == as_int(mask.size())));
            CHECK(locate_map(mesh, *back, precision).map.values == map.values);
        }
    }
}

TEST_CASE("locate_map: one thread and several give the same map") {
    const BaseMesh mesh = test::jittered_grid(0, 0, 299, 149, 20, 15, 4);
    const Displacements d = random_displacements(300, 150, 16, 2, 1);
    const PixelMap many = locate_map(mesh, d, WeightPrecision::kHalf).map;
    const auto back = displacements_of(mesh, many);
    const ThreadLimit limit(1);
    CHECK(locate_map(mesh, d, WeightPrecision::kHalf).map == many);
    CHECK(displacements_of(mesh, many) == back);
}

TEST_CASE("locate_map: the first pixel on no face") {
    const BaseMesh mesh = test::jittered_grid(0, 0, 40, 29, 4, 3, 1);
    Displacements d = random_displacements(41, 60, 8, 0, 1);
    const LocatedMap below = locate_map(mesh, d, WeightPrecision::kHalf);
    CHECK(below.lost == d.index(0, 30));
    CHECK(below.map.empty());
    d.dx[d.index(40, 7)] = 1;
    CHECK(locate_map(mesh, d, WeightPrecision::kHalf).lost == d.index(40, 7));
    d.inside = Mask(d, 1);
    d.inside[d.index(40, 7)] = 0;
    for (int y = 30; y < 60; ++y)
        for (int x = 0; x < 41; ++x) d.inside[d.index(x, y)] = 0;
    CHECK(!locate_map(mesh, d, WeightPrecision::kHalf).lost);
}

// What a file may hold: nothing may take long, and nothing but these errors comes.
TEST_CASE("locate_map: meshes that no pixel can be found in are refused") {
    BaseMesh mesh = test::jittered_grid(0, 0, 200, 200, 2, 2, 1);
    Displacements d = random_displacements(201, 201, 32, 0, 1);
    const auto refused = [&] {
        CHECK_THROWS_AS(locate_map(mesh, d, WeightPrecision::kFloat), Error);
        PixelMap map = trivial_map(test::jittered_grid(0, 0, 200, 200, 2, 2, 1), 201, 201);
        CHECK(!displacements_of(mesh, map));
    };
    SUBCASE("splinters across the whole image") {
        for (int i = 0; i < 60000; ++i) {
            const auto first = as_id(mesh.position.size());
            const float x = static_cast<float>(i % 6400) / 32;
            mesh.position.insert(mesh.position.end(), {{x, 0}, {0, 200}, {x + 1.0f / 32, 0}});
            mesh.faces.push_back({first, first + 1, first + 2});
        }
        refused();
    }
    SUBCASE("very many faces at one place, and all pixels there") {
        for (int i = 0; i < 60000; ++i) {
            const auto first = as_id(mesh.position.size());
            const float x = 100 + static_cast<float>(i % 32) / 32,
                        y = 100 + static_cast<float>(i / 32 % 32) / 32;
            const float step = 1.0f / 32;
            mesh.position.insert(mesh.position.end(), {{x, y}, {x, y + step}, {x + step, y + step}});
            mesh.faces.push_back({first, first + 1, first + 2});
        }
        mesh.faces.erase(mesh.faces.begin(), mesh.faces.begin() + 8);
        std::mt19937 random(1);
        for (std::size_t i = 0; i < d.pixel_count(); ++i) {
            d.dx[i] = static_cast<std::int16_t>((100 - d.x_of(i)) * 32 + static_cast<int>(random() % 32));
            d.dy[i] = static_cast<std::int16_t>((100 - d.y_of(i)) * 32 + static_cast<int>(random() % 32));
        }
        CHECK_THROWS_AS(locate_map(mesh, d, WeightPrecision::kFloat), Error);
    }
    SUBCASE("a vertex off the grid") {
        mesh.position[0].x() += 1.0f / 64;
        refused();
    }
    SUBCASE("a vertex that is no place") {
        mesh.position[0].x() = std::numeric_limits<float>::quiet_NaN();
        refused();
    }
    SUBCASE("a vertex too far away") {
        mesh.position[0].x() = -131072;
        refused();
    }
}

TEST_CASE("locate_map: flipped and degenerate faces hold nothing") {
    BaseMesh mesh = test::jittered_grid(0, 0, 8, 8, 1, 1, 1);
    for (Face& f : mesh.faces) std::swap(f[0], f[1]);
    mesh.faces.push_back({0, 1, 1});
    CHECK(locate_map(mesh, random_displacements(9, 9, 8, 0, 1), WeightPrecision::kHalf).lost == 0u);
}

TEST_CASE("displacements_of: only maps on a grid have some") {
    const BaseMesh mesh = test::jittered_grid(0, 0, 60, 50, 5, 4, 1);
    const PixelMap map =
        locate_map(mesh, random_displacements(61, 51, 32, 1, 1), WeightPrecision::kFloat).map;
    const auto back = displacements_of(mesh, map);
    REQUIRE(back.has_value());
    CHECK(back->steps == 32);

    PixelMap other = map;
    std::size_t middle = map.index(30, 25);
    other[middle].u = other[middle].u > 0.5f ? other[middle].u - kFloatWeightStep * 9999
                                             : other[middle].u + kFloatWeightStep * 9999;
    if (other[middle].u + other[middle].v > 1) other[middle].v = 1 - other[middle].u;
    CHECK(!displacements_of(mesh, other));  // off the grid

    other = map;
    std::swap(other[middle], other[middle + 1]);
    CHECK(displacements_of(mesh, other).has_value());  // a fold does not matter

    other = map;
    other[middle].face = as_id(mesh.faces.size());
    CHECK(!displacements_of(mesh, other));  // no such face

    // The same place by the other face of an edge.
    BaseMesh square;
    square.position = {{0, 0}, {0, 4}, {4, 4}, {4, 0}};
    square.feature.assign(12, 0);
    square.faces = {{0, 1, 2}, {2, 3, 0}};
    PixelMap corners = locate_map(square, random_displacements(5, 5, 8, 0, 1), WeightPrecision::kFloat).map;
    CHECK(corners[0] == PixelCoord{1, 0, 1});
    CHECK(displacements_of(square, corners).has_value());
    corners[0] = {0, 0, 0};
    CHECK(!displacements_of(square, corners));
}

TEST_CASE("displacements_of: a displacement of more than 16 bits takes coarser steps, or there is none") {
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 9000}, {9000, 9000}, {9000, 0}};
    mesh.feature.assign(12, 0);
    mesh.faces = {{0, 1, 2}, {2, 3, 0}};
    const auto map_at = [&](float weight) {
        return PixelMap(1, 1, {{0, weight, 0}}, WeightPrecision::kFloat);
    };
    const auto near = displacements_of(mesh, map_at(0.25f));  // 2250 pixels
    REQUIRE(near.has_value());
    CHECK(near->dy[0] == 2250 * 8);
    CHECK(!displacements_of(mesh, map_at(0.5f)));  // 4500
}

// Places with the same weights in 1/2048 are then far apart along the faces, and rare across them.
TEST_CASE("displacements_of: long and thin faces with weights in halves") {
    const BaseMesh mesh = test::jittered_grid(0, 0, 2400, 60, 2, 6, 1);
    for (const int steps : {8, 16, 32}) {
        const PixelMap map =
            locate_map(mesh, random_displacements(2401, 61, steps, 1.5, 1), WeightPrecision::kHalf).map;
        const auto back = displacements_of(mesh, map);
        REQUIRE(back.has_value());
        CHECK(locate_map(mesh, *back, WeightPrecision::kHalf).map.values == map.values);
    }
}
