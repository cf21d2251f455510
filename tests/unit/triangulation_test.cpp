// The triangulation that coded faces are sought in.
#include <doctest/doctest.h>

#include <numeric>
#include <random>
#include <set>

#include "libcore/coding/triangulation.h"

using namespace imgmesh;
using namespace imgmesh::coding;

namespace {

// Distinct points of a square with its corners, many of them on one line or one circle.
std::vector<Place> scattered(std::uint32_t seed, std::size_t count, int side) {
    std::mt19937 random(seed);
    std::set<std::pair<int, int>> points = {{0, 0}, {0, side}, {side, 0}, {side, side}};
    while (points.size() < count) {
        const int x = static_cast<int>(random() % static_cast<unsigned>(side + 1));
        points.insert({x, static_cast<int>(random() % static_cast<unsigned>(side + 1))});
    }
    std::vector<Place> places;
    for (const auto& [x, y] : points) places.push_back({x, y});
    return places;
}

Triangulation triangulated(const std::vector<Place>& places) {
    std::vector<Id> order(places.size());
    std::iota(order.begin(), order.end(), Id{0});
    return {places, order};
}

// Positive areas that sum up to the square, and each face lies across the edge that it shares.
void check_sound(const Triangulation& faces, int side) {
    std::int64_t area = 0;
    for (Id f = 0; f < faces.face_count(); ++f) {
        const auto& [corner, across, known] = faces.face(f);
        const std::int64_t own =
            area2(faces.place(corner[0]), faces.place(corner[1]), faces.place(corner[2]));
        REQUIRE(own > 0);
        area += own;
        for (std::size_t i = 0; i < 3; ++i) {
            const Id a = corner[(i + 1) % 3], b = corner[(i + 2) % 3];
            CHECK(faces.face_at(a, b) == f);
            CHECK(faces.face_at(b, a) == across[i]);
        }
    }
    CHECK(area == 2 * std::int64_t{side} * side);
}

}  // namespace

TEST_CASE("a point lies inside a circle or not, on screen") {
    const Place a{0, 0}, b{0, 4}, c{4, 4};  // counter-clockwise on screen, where y goes down
    REQUIRE(area2(a, b, c) > 0);
    CHECK(inside_circle(a, b, c, {3, 1}));
    CHECK_FALSE(inside_circle(a, b, c, {4, 0}));  // on the circle
    CHECK_FALSE(inside_circle(a, b, c, {5, 0}));
    // Products of differences that large need more than 64 bits.
    const int far = 1 << 18;
    CHECK(inside_circle({0, 0}, {0, far}, {far, far}, {far - 1, 1}));
    CHECK_FALSE(inside_circle({0, 0}, {0, far}, {far, far}, {far, 0}));
}

TEST_CASE("no vertex lies inside the circle of a face") {
    for (const std::uint32_t seed : {1u, 2u, 3u})
        for (const int side : {7, 40, 1000}) {
            const std::vector<Place> places = scattered(seed, 50, side);
            const Triangulation faces = triangulated(places);
            check_sound(faces, side);
            for (Id f = 0; f < faces.face_count(); ++f) {
                const auto& corner = faces.face(f).corner;
                for (const Place& p : places)
                    CHECK_FALSE(inside_circle(faces.place(corner[0]), faces.place(corner[1]),
                                              faces.place(corner[2]), p));
            }
        }
}

TEST_CASE("a fixed face stays, and what its strip covers is triangulated again") {
    // A fan of four faces above the edge from (0, 8) to (8, 8), whose far end is the wanted apex.
    const std::vector<Place> places = {{0, 0}, {8, 0}, {0, 8}, {8, 8}, {4, 1}, {1, 4}, {7, 4}};
    Triangulation faces = triangulated(places);
    const Id a = 2, b = 3, c = 4;
    std::vector<Id> strip = {faces.face_at(a, b)};
    // The faces between the gate and (4, 1) are those whose edges separate them.
    while (faces.face(strip.back()).corner[0] != c && faces.face(strip.back()).corner[1] != c &&
           faces.face(strip.back()).corner[2] != c) {
        const LinkedFace& face = faces.face(strip.back());
        for (std::size_t i = 0; i < 3; ++i) {
            const Place p = faces.place(face.corner[(i + 1) % 3]), q = faces.place(face.corner[(i + 2) % 3]);
            const Id next = face.across[i];
            if (next != kNone && area2(p, q, faces.place(c)) < 0 &&
                (strip.size() == 1 || next != strip[strip.size() - 2])) {
                strip.push_back(next);
                break;
            }
        }
    }
    REQUIRE(strip.size() > 1);
    faces.fix_face(a, b, c, strip);
    check_sound(faces, 8);
    const LinkedFace& fixed = faces.face(faces.face_at(a, b));
    CHECK(fixed.known);
    CHECK(std::set<Id>(fixed.corner.begin(), fixed.corner.end()) == std::set<Id>{a, b, c});
}
