#include <doctest/doctest.h>

#include "libcore/base/parallel.h"
#include "libcore/mesh/raster.h"
#include "libcore/mesh/trivial_map.h"
#include "tests/support/meshes.h"

using namespace imgmesh;

namespace {

// The definition, face by face: the lowest face that holds the sample.
PixelCoord brute_force(const BaseMesh& mesh, double x, double y) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        const auto area = [&](Id p, Id q) {
            const double px = mesh.position[p].x() - x, py = mesh.position[p].y() - y,
                         qx = mesh.position[q].x() - x, qy = mesh.position[q].y() - y;
            return py * qx - px * qy;
        };
        const double wa = area(b, c), wb = area(c, a), wc = area(a, b), sum = wa + wb + wc;
        if (sum > 0 && wa >= 0 && wb >= 0 && wc >= 0)
            return {static_cast<Id>(f), static_cast<float>(wb / sum), static_cast<float>(wc / sum)};
    }
    return {};
}

void check_against_brute_force(const BaseMesh& mesh, const SampleGrid& grid, bool covered) {
    const PixelMap map = rasterize(mesh, grid);
    REQUIRE(map.size() == grid.x.size() * grid.y.size());
    int wrong_face = 0, wrong_weight = 0, uncovered = 0;
    for (std::size_t j = 0; j < grid.y.size(); ++j)
        for (std::size_t i = 0; i < grid.x.size(); ++i) {
            const PixelCoord got = map[j * grid.x.size() + i], want = brute_force(mesh, grid.x[i], grid.y[j]);
            wrong_face += got.face != want.face;
            uncovered += got.face == kNone;
            const float w = 1 - got.u - got.v, steps = got.u / kFloatWeightStep;
            wrong_weight += std::abs(got.u - want.u) > 1e-7f || std::abs(got.v - want.v) > 1e-7f ||
                            got.u < 0 || got.v < 0 || w < 0 || steps != std::floor(steps);
        }
    CHECK(wrong_face == 0);
    CHECK(wrong_weight == 0);
    if (covered) CHECK(uncovered == 0);
}

}  // namespace

TEST_CASE("rasterize: random meshes agree with brute force and leave no pixel out") {
    for (std::uint32_t seed = 1; seed <= 30; ++seed) {
        INFO("seed " << seed);
        const int w = 20 + static_cast<int>(seed) * 2, h = 50 - static_cast<int>(seed);
        const BaseMesh mesh =
            test::jittered_grid(0, 0, w - 1, h - 1, 3 + int(seed % 7), 2 + int(seed % 5), seed);
        for (const Face& f : mesh.faces)
            REQUIRE(signed_area2(mesh.position[f[0]], mesh.position[f[1]], mesh.position[f[2]]) > 0);
        for (const double scale : {1.0, 0.3, 2.0, 3.7})
            check_against_brute_force(mesh, sample_grid(w, h, scale), true);
    }
}

// All pixel centres lie on vertices or edges here: every one is a tie.
TEST_CASE("rasterize: the full pixel grid, where every sample is a tie") {
    BaseMesh mesh = test::jittered_grid(0, 0, 12, 9, 12, 9, 5);
    for (Vec2f& p : mesh.position) p = {std::round(p.x()), std::round(p.y())};
    check_against_brute_force(mesh, sample_grid(13, 10, 1), true);
    check_against_brute_force(mesh, sample_grid(13, 10, 4), true);
}

TEST_CASE("rasterize: a mesh smaller than the image covers its inside and border only") {
    const BaseMesh mesh = test::jittered_grid(2, 3, 10, 9.5, 3, 2, 7);
    check_against_brute_force(mesh, sample_grid(14, 12, 1), false);
    const PixelMap map = trivial_map(mesh, 14, 12);
    CHECK(map.row(3)[1].face == kNone);
    CHECK(map.row(3)[2].face != kNone);
    CHECK(map.row(9)[10].face != kNone);
    CHECK(map.row(10)[10].face == kNone);
}

TEST_CASE("rasterize: strips of one pixel and a single pixel") {
    check_against_brute_force(test::jittered_grid(0, -0.5, 39, 0.5, 5, 1, 1), sample_grid(40, 1, 1), true);
    check_against_brute_force(test::jittered_grid(-0.5, 0, 0.5, 39, 1, 5, 2), sample_grid(1, 40, 3), true);
    check_against_brute_force(test::jittered_grid(-0.5, -0.5, 0.5, 0.5, 1, 1, 3), sample_grid(1, 1, 1), true);
}

TEST_CASE("rasterize: flipped and degenerate faces cover nothing") {
    BaseMesh mesh = test::jittered_grid(0, 0, 8, 8, 1, 1, 1);
    for (Face& f : mesh.faces) std::swap(f[0], f[1]);
    mesh.faces.push_back({0, 1, 1});
    for (const PixelCoord& c : trivial_map(mesh, 9, 9).values) CHECK(c == PixelCoord{});
}

TEST_CASE("rasterize: one thread and several give the same map") {
    const BaseMesh mesh = test::jittered_grid(0, 0, 199, 149, 20, 15, 4);
    const PixelMap many = trivial_map(mesh, 200, 150);
    const ThreadLimit limit(1);
    CHECK(trivial_map(mesh, 200, 150).values == many.values);
}

TEST_CASE("sample_grid: positions of an enlarged image") {
    const SampleGrid grid = sample_grid(3, 1, 2);
    CHECK(grid.x == std::vector<double>{0, 0.25, 0.75, 1.25, 1.75, 2});
    CHECK(grid.y == std::vector<double>{-0.25, 0.25});
    CHECK(sample_grid(3, 2, 0.1).x.size() == 1);
}
