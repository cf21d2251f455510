// Other proportions for an image.
#include "libcore/warp/retarget.h"

#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/error.h"
#include "tests/support/warp_samples.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// A grid whose columns and rows are eight times as dense in the middle, as a collapse leaves them around an
// object.
MeshImage object_in_the_middle(int side) {
    MeshImage m = grid_pyramid(side, side, {24});
    for (Vec2f& p : m.levels[0].mesh.position)
        for (float& at : p.reshaped()) {
            const double t = double(at) / (side - 1) * 2 - 1;  // -1 to 1
            const double moved = (0.25 * t + 0.75 * t * t * t + 1) / 2 * (side - 1);
            at = snapped(static_cast<float>(moved));
        }
    m.levels[0].map = trivial_map(m.levels[0].mesh, side, side);
    return m;
}

}  // namespace

TEST_CASE("retarget_moves: the same proportions change nothing") {
    const MeshImage m = object_in_the_middle(101);
    for (const int side : {50, 101, 333})
        for (const Vec2f& move : retarget_moves(m.levels[0].mesh, 101, 101, {side, side}))
            CHECK(move.norm() < 1e-3f);
}

TEST_CASE("retarget_moves: sides stay sides, and no face turns over, whatever the size") {
    const BaseMesh mesh = jittered_grid(0, 0, 70, 50, 9, 7, 5);
    for (const OutputSize size : {OutputSize{1, 1}, {1, 500}, {35, 51}, {71, 20}, {3000, 10}, {200, 400}}) {
        const VertexMoves moves = retarget_moves(mesh, 71, 51, size);
        for (Id v = 0; v < moves.size(); ++v) {
            if (mesh.position[v].x() == 0 || mesh.position[v].x() == 70)
                CHECK(std::abs(moves[v].x()) < 1e-3f);
            if (mesh.position[v].y() == 0 || mesh.position[v].y() == 50)
                CHECK(std::abs(moves[v].y()) < 1e-3f);
        }
        for (const auto& [a, b, c] : mesh.faces)
            CHECK(signed_area2(mesh.position[a] + moves[a], mesh.position[b] + moves[b],
                               mesh.position[c] + moves[c]) > 0);
    }
}

// The purpose of retargeting.
TEST_CASE("retarget_field: detail keeps its proportions, the rest gives way") {
    const MeshImage m = object_in_the_middle(101);
    const DisplacementField field = retarget_field(m, {61, 101});
    CHECK(folded_cells(field) == 0);
    const auto at = [&](int x, int y) {
        return Vec2f(Vec2f(float(x), float(y)) + field.move[field.index(x, y)]);
    };
    const auto ratio = [&](int x, int y, int reach) {
        const float across = (at(x + reach, y) - at(x - reach, y)).x() * 61 / 101,
                    down = (at(x, y + reach) - at(x, y - reach)).y();
        return across / down;
    };
    CHECK(ratio(50, 50, 8) > 0.85f);  // plain scaling: 0.6
    CHECK(ratio(12, 12, 8) < 0.5f);
    CHECK(ratio(88, 88, 8) < 0.5f);
    const Image out = warp_image(noise_image(101, 101, 3), field, {61, 101});
    CHECK(out.width == 61);
    CHECK(out.channels == 3);
}

TEST_CASE("retarget_field: thin images work, masked images are refused") {
    for (const auto& [w, h] : {std::pair(1, 1), {1, 9}, {9, 1}, {3, 3}}) {
        const DisplacementField field = retarget_field(grid_pyramid(w, h, {1}), {5, 4});
        for (const Vec2f& move : field.move) CHECK(move.allFinite());
        CHECK(warp_image(noise_image(w, h, 3), field, {5, 4}).channels == 3);
    }
    MeshImage m = grid_pyramid(9, 9, {2});
    apply_mask(m, [](int x, int) { return x > 2; });
    CHECK_THROWS_AS(retarget_field(m, {5, 5}), Error);
}

// A file may hold any number of faces over one another, and then neither the cover nor the systems have
// bounds.
TEST_CASE("faces that lie over one another are refused before any work") {
    MeshImage m = grid_pyramid(60, 60, {1});
    const std::vector<Face> two = m.levels[0].mesh.faces;
    for (int i = 0; i < 100; ++i)
        m.levels[0].mesh.faces.insert(m.levels[0].mesh.faces.end(), two.begin(), two.end());
    CHECK_THROWS_WITH_AS(retarget_field(m, {10, 60}), doctest::Contains("times over"), Error);
}
