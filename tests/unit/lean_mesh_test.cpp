// Coarser positions and colours.
#include <doctest/doctest.h>

#include <random>
#include <set>

#include "libcore/image/color.h"
#include "libcore/image/color_levels.h"
#include "libcore/mesh/round_positions.h"
#include "libcore/pipeline/lean_mesh.h"
#include "tests/support/random_mesh_image.h"

using namespace imgmesh;

namespace {

bool on_step(const Vec2f& p, float step) {
    return p.x() / step == std::floor(p.x() / step) && p.y() / step == std::floor(p.y() / step);
}

double area2(const BaseMesh& mesh) {
    double sum = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const double face = signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]);
        CHECK(face > 0);
        sum += face;
    }
    return sum;
}

}  // namespace

TEST_CASE("colour levels: 256 of them are the values of 8-bit images, and every level stays") {
    const ColorLevels levels(256);
    std::set<std::uint16_t> codes;
    for (int code = 0; code < 65536; ++code) {
        const std::uint16_t level = levels.nearest(static_cast<std::uint16_t>(code));
        codes.insert(level);
        CHECK(levels.nearest(level) == level);
    }
    CHECK(codes.size() == 256);
    for (int value = 0; value < 256; ++value) {
        const float x = static_cast<float>(value) / 255;
        const float linear = linear_from_encoded(ColorSpace::kSrgb, Vec3f(x, x, x))[0];
        CHECK(codes.count(static_cast<std::uint16_t>(std::lround(linear * 65535.0f))) == 1);
    }
}

TEST_CASE("colour levels: each code goes to the level with the nearest sRGB value") {
    const auto encoded = [](int code) {
        const float x = static_cast<float>(code) / 65535.0f;
        return double{encoded_from_linear(ColorSpace::kSrgb, Vec3f(x, x, x))[0]};
    };
    for (const int count : {2, 3, 64, 90, 4096}) {
        const ColorLevels levels(count);
        const double half = 0.5 / (count - 1);
        CHECK(levels.nearest(0) == 0);
        CHECK(levels.nearest(65535) == 65535);
        for (int code = 0; code < 65536; code += 13)
            CHECK(std::abs(encoded(levels.nearest(static_cast<std::uint16_t>(code))) - encoded(code)) <
                  half + 2e-4);
    }
}

TEST_CASE("colour levels: a rounded colour is one that a container keeps, bit for bit") {
    std::mt19937 random(3);
    const ColorLevels levels(90);
    for (int n = 0; n < 3000; ++n) {
        const Vec3f luv(static_cast<float>(random() % 1300) / 10 - 10,
                        static_cast<float>(random() % 400) - 200, static_cast<float>(random() % 400) - 200);
        const Vec3f rounded = levels.rounded(luv);
        CHECK(quantized_color(rounded) == rounded);
        CHECK(levels.rounded(rounded) == rounded);
    }
}

TEST_CASE("rounded positions: faces keep their sides, the mesh its rectangle, vertices stay near") {
    std::mt19937 random(4);
    struct Case {
        int width, height, cells_x, cells_y;
    };
    for (const Case& c : {Case{60, 40, 8, 6}, {60, 40, 25, 18}, {1, 30, 1, 7}, {2, 2, 1, 1}})
        for (const float step : {1.0f / 16, 0.25f, 0.5f, 1.0f}) {
            INFO(c.width << "x" << c.height << " step " << step);
            const BaseMesh mesh = random_mesh(c.width, c.height, c.cells_x, c.cells_y, random);
            BaseMesh rounded = mesh;
            const std::size_t fine = round_positions(rounded, step);
            std::size_t off = 0;
            for (Id v = 0; v < mesh.vertex_count(); ++v) {
                off += !on_step(rounded.position[v], step);
                CHECK((rounded.position[v] - mesh.position[v]).norm() <= 3 * step);
            }
            CHECK(fine == off);
            if (step <= 0.5f) CHECK(fine == 0);
            CHECK(area2(rounded) == area2(mesh));
            CHECK(rounded.faces == mesh.faces);
        }
}

TEST_CASE("rounded positions: a vertex without a place stays, and so does a slanted boundary") {
    // The middle of a triangle that has no other point of the grid of 1 pixel inside.
    BaseMesh mesh;
    mesh.position = {{0, 0}, {0, 1}, {1, 0}, {0.25f, 0.25f}};
    mesh.feature.resize(12);
    mesh.faces = {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    const BaseMesh before = mesh;
    CHECK(round_positions(mesh, 1) == 1);
    CHECK(mesh.position == before.position);

    // The end of the slanted side is no multiple of the step, and moving it would change what is covered.
    mesh.position = {{0, 0}, {0, 8}, {7, 1.25f}};
    mesh.feature.resize(9);
    mesh.faces = {{0, 1, 2}};
    CHECK(round_positions(mesh, 1) == 1);
    CHECK(mesh.position[2] == Vec2f(7, 1.25f));
}

TEST_CASE("compact positions: half a pixel at 1 %, finer where vertices are nearer") {
    CHECK(compact_step(393216, 3932) == 0.5);
    CHECK(compact_step(393216, 100) == 0.5);
    CHECK(compact_step(10000, 400) == 0.25);
    CHECK(compact_step(10000, 10000) == 0.0625);
    CHECK(compact_step(1, 4) == 0.03125);
}
