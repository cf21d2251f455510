// Outlines of masks: contours by hand, and that simplified ones cut no pixel, stay near and can be meshed.
#include "libcore/mesh/outline.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "libcore/base/error.h"
#include "libcore/mesh/raster.h"
#include "libcore/mesh/triangulate.h"
#include "tests/support/face_areas.h"

using namespace imgmesh;
using test::area_of_faces;

namespace {

Mask drawn(const std::vector<std::string>& rows) {
    Mask mask{static_cast<int>(rows[0].size()), static_cast<int>(rows.size()), {}};
    for (const std::string& row : rows)
        for (const char c : row) mask.values.push_back(c == '#');
    return mask;
}

template <typename Inside>
Mask shape(int width, int height, Inside inside) {
    Mask mask{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) mask.values.push_back(inside(x, y));
    return mask;
}

// Samples (4 x 4 a pixel) inside the mask that no face covers.
std::int64_t uncovered(const BaseMesh& mesh, const Mask& mask) {
    SampleGrid grid;
    for (int i = 0; i < 4 * mask.width; ++i) grid.x.push_back((i + 0.5) / 4 - 0.5);
    for (int i = 0; i < 4 * mask.height; ++i) grid.y.push_back((i + 0.5) / 4 - 0.5);
    const PixelMap raster = rasterize(mesh, grid);
    std::int64_t bare = 0;
    for (int y = 0; y < raster.height; ++y)
        for (int x = 0; x < raster.width; ++x) bare += mask.at(x / 4, y / 4) && raster.at(x, y).face == kNone;
    return bare;
}

// The largest distance of a sample inside the mesh from the nearest pixel square inside.
double farthest(const BaseMesh& mesh, const Mask& mask) {
    SampleGrid grid;
    for (int i = 0; i < 2 * mask.width; ++i) grid.x.push_back((i + 0.5) / 2 - 0.5);
    for (int i = 0; i < 2 * mask.height; ++i) grid.y.push_back((i + 0.5) / 2 - 0.5);
    const PixelMap raster = rasterize(mesh, grid);
    double most = 0;
    for (int y = 0; y < raster.height; ++y)
        for (int x = 0; x < raster.width; ++x) {
            if (raster.at(x, y).face == kNone || mask.at(x / 2, y / 2)) continue;
            double least = 1e9;
            for (int v = 0; v < mask.height; ++v)
                for (int u = 0; u < mask.width; ++u)
                    if (mask.at(u, v))
                        least = std::min(least,
                                         std::hypot(std::max(std::abs(grid.x[as_index(x)] - u) - 0.5, 0.0),
                                                    std::max(std::abs(grid.y[as_index(y)] - v) - 0.5, 0.0)));
            most = std::max(most, least);
        }
    return most;
}

}  // namespace

TEST_CASE("mask_contours: a pixel, a ring, and pixels that touch at a corner") {
    const auto one = mask_contours(drawn({"...", ".#.", "..."}));
    REQUIRE(one.size() == 1);
    CHECK(one[0].size() == 4);
    const auto ring = mask_contours(drawn({"###", "#.#", "###"}));
    REQUIRE(ring.size() == 2);
    CHECK(ring[0].size() == 4);
    CHECK(ring[1].size() == 4);
    CHECK(area_of_faces(triangulated(ring)) == 8);
    CHECK(triangulated(ring).faces.size() == 8);
    const auto corner = mask_contours(drawn({"#.", ".#"}));
    REQUIRE(corner.size() == 2);
    CHECK(corner[0].size() == 4);
    CHECK(corner[1].size() == 4);
    // A hole that touches the outside at a corner is an outline of its own all the same.
    CHECK(area_of_faces(triangulated(mask_contours(drawn({"####", "##.#", "###.", "####"})))) == 14);
}

TEST_CASE("triangulated: the contour of any mask, with its own area") {
    std::mt19937 random(5);
    for (int round = 0; round < 30; ++round) {
        const Mask mask = shape(14, 11, [&](int, int) { return random() % 4 > 0; });
        const BaseMesh mesh = triangulated(mask_contours(mask));
        CHECK(area_of_faces(mesh) == double(mask.count()));
        CHECK(uncovered(mesh, mask) == 0);
    }
}

TEST_CASE("simplified_outline: grows only, and stays near") {
    std::mt19937 random(6);
    const Mask shapes[] = {
        shape(64, 64, [](int x, int y) { return std::hypot(x - 31.5, y - 31.5) < 32; }),
        shape(60, 50, [](int x, int y) { return std::abs(std::hypot(x - 30, y - 24) - 16) < 6; }),
        shape(60, 50, [](int x, int y) { return std::sin(x * 0.35) + std::cos(y * 0.41 + x * 0.05) > 0.2; }),
        shape(30, 30, [&](int, int) { return random() % 3 > 0; })};
    for (const Mask& mask : shapes) {
        std::size_t before = std::numeric_limits<std::size_t>::max();
        for (const double tolerance : {0.0, 0.5, 1.0, 2.0, 4.0}) {
            const auto loops = simplified_outline(mask, tolerance, OutlineSide::kOut);
            const BaseMesh mesh = triangulated(loops);
            CAPTURE(tolerance);
            CHECK(uncovered(mesh, mask) == 0);
            CHECK(farthest(mesh, mask) <= tolerance + 1e-6);
            CHECK(area_of_faces(mesh) >= double(mask.count()));
            CHECK(mesh.faces.size() <= before);
            before = mesh.faces.size() + 2;
            for (const Vec2f& p : mesh.position) {
                CHECK(snapped(p.x()) == p.x());
                CHECK(p.x() >= -0.5f);
                CHECK(p.y() <= static_cast<float>(mask.height) - 0.5f);
            }
        }
    }
    CHECK(triangulated(simplified_outline(shapes[0], 1, OutlineSide::kOut)).faces.size() <= 25);
    // The ring keeps its hole.
    CHECK(simplified_outline(shapes[1], 4, OutlineSide::kOut).size() == 2);
}

TEST_CASE("simplified_outline: on either side the vertices of the contour are near, and there are fewer") {
    const Mask disc = shape(64, 64, [](int x, int y) { return std::hypot(x - 31.5, y - 31.5) < 30; });
    for (const double tolerance : {1.5, 3.0}) {
        const auto both = simplified_outline(disc, tolerance, OutlineSide::kBoth);
        const auto out = simplified_outline(disc, tolerance, OutlineSide::kOut);
        REQUIRE(both.size() == 1);
        CHECK(both[0].size() <= out[0].size() + 4);
        CHECK(area_of_faces(triangulated(both)) < area_of_faces(triangulated(out)));
        CHECK(std::abs(area_of_faces(triangulated(both)) - double(disc.count())) < tolerance * 190);
    }
    CHECK_THROWS_AS(simplified_outline(Mask{3, 3, std::vector<std::uint8_t>(9)}, 1, OutlineSide::kOut),
                    Error);
}
