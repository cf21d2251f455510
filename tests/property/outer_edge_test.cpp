// outer_positions(): rectangles by hand; whole pixel squares covered, for masks of any shape.
#include "libcore/mesh/outer_edge.h"

#include <doctest/doctest.h>

#include <random>

#include "libcore/mesh/raster.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build.h"
#include "tests/support/face_areas.h"

using namespace imgmesh;
using test::area_of_faces;

namespace {

Image random_image(int width, int height, std::uint32_t seed) {
    std::mt19937 random(seed);
    Image image = make_image(width, height, 3);
    for (float& x : image.data) x = static_cast<float>(random() % 256) / 255;
    return image;
}

Mask rectangle(int width, int height, const PixelRect& inside) {
    Mask mask{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            mask.values.push_back(x >= inside.left && x < inside.right && y >= inside.top &&
                                  y < inside.bottom);
    return mask;
}

MeshImage built(const Image& image, const Mask& mask, double density) {
    BuildParams params;
    params.stop.density = density;
    return build_mesh_image(image, params, {}, mask).mesh_image;
}

// Samples of 4 x 4 in every pixel square inside that no face covers, of all.
std::pair<std::int64_t, std::int64_t> uncovered(const BaseMesh& mesh, const PixelMap& map) {
    SampleGrid grid;
    for (int i = 0; i < 4 * map.width; ++i) grid.x.push_back((static_cast<float>(i) + 0.5f) / 4 - 0.5f);
    for (int i = 0; i < 4 * map.height; ++i) grid.y.push_back((static_cast<float>(i) + 0.5f) / 4 - 0.5f);
    const PixelMap raster = rasterize(mesh, grid);
    std::int64_t bare = 0, all = 0;
    for (int y = 0; y < raster.height; ++y)
        for (int x = 0; x < raster.width; ++x) {
            if (map.at(x / 4, y / 4).face == kNone) continue;
            ++all;
            bare += raster.at(x, y).face == kNone;
        }
    return {bare, all};
}

void move_out(MeshImage& m) {
    for (Level& level : m.levels) level.mesh.position = outer_positions(level.mesh, level.map);
}

// bare_share: of the samples, that may lie outside.
void check_covered(const Image& image, const Mask& mask, double density, double bare_share) {
    MeshImage m = built(image, mask, density);
    const Level before = m.levels[0];
    move_out(m);
    const auto& [mesh, map, error] = m.levels[0];
    const auto [bare, all] = uncovered(mesh, map);
    CAPTURE(all);
    CAPTURE(density);
    CHECK(double(bare) <= bare_share * double(all));
    CHECK(area_of_faces(mesh) > area_of_faces(before.mesh));
    // What covers its pixels stays.
    move_out(m);
    CHECK(m.levels[0].mesh.position == mesh.position);
    for (const Vec2f& p : mesh.position) {
        CHECK(snapped(p.x()) == p.x());
        CHECK(snapped(p.y()) == p.y());
    }
}

}  // namespace

TEST_CASE("outer edge: rectangles are exactly as large as their pixels") {
    const Image image = random_image(64, 48, 1);
    for (const PixelRect& r : {PixelRect{12, 9, 52, 41}, PixelRect{0, 0, 40, 32}, PixelRect{5, 0, 64, 48},
                               PixelRect{0, 0, 64, 48}, PixelRect{3, 3, 5, 5}})
        for (const double density : {0.5, 5.0, 100.0}) {
            MeshImage m = built(image, rectangle(64, 48, r), density);
            move_out(m);
            CHECK(area_of_faces(m.levels[0].mesh) == r.width() * r.height());
            for (const Vec2f& p : m.levels[0].mesh.position) {
                CHECK(p.x() >= static_cast<float>(r.left) - 0.5f);
                CHECK(p.x() <= static_cast<float>(r.right) - 0.5f);
                CHECK(p.y() >= static_cast<float>(r.top) - 0.5f);
                CHECK(p.y() <= static_cast<float>(r.bottom) - 0.5f);
            }
        }
}

TEST_CASE("outer edge: sides of one pixel") {
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 9}, std::pair{9, 1}}) {
        MeshImage m = built(random_image(width, height, 2), {}, 100);
        move_out(m);
        CHECK(area_of_faces(m.levels[0].mesh) == width * height);
    }
}

TEST_CASE("outer edge: every pixel square inside is covered, for masks of any shape") {
    const Image image = random_image(60, 50, 3);
    std::mt19937 random(4);
    for (const double density : {1.0, 6.0, 40.0}) {
        Mask disc{60, 50, {}}, ring = disc, noise = disc, diamond = disc, blobs = disc;
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 60; ++x) {
                const double r = std::hypot(x - 29.3, y - 24.8);
                disc.values.push_back(r < 22);
                ring.values.push_back(r < 24 && r > 9.5);
                noise.values.push_back(random() % 3 > 0);
                diamond.values.push_back(std::abs(x - 30) + std::abs(y - 25) <= 23);
                blobs.values.push_back(std::sin(x * 0.35) + std::cos(y * 0.41 + x * 0.05) > 0.2);
            }
        for (const Mask* mask : {&disc, &ring, &diamond, &blobs}) check_covered(image, *mask, density, 0);
        // Holes and single pixels everywhere.
        check_covered(image, noise, density, 0.01);
    }
}

TEST_CASE("outer edge: maps are moved without a fold, and most of the edge is reached") {
    const Image image = random_image(60, 50, 3);
    std::mt19937 random(7);
    for (const double density : {1.0, 6.0, 40.0}) {
        Mask disc{60, 50, {}}, noise = disc;
        for (int y = 0; y < 50; ++y)
            for (int x = 0; x < 60; ++x) {
                disc.values.push_back(std::hypot(x - 29.3, y - 24.8) < 22);
                noise.values.push_back(random() % 3 > 0);
            }
        for (const Mask* mask : {&disc, &noise}) {
            MeshImage m = built(image, *mask, density);
            const Level before = m.levels[0];
            MeshImage folded = m;
            move_out(folded);
            extend_to_outer_edge(m);
            const auto& [mesh, map, error] = m.levels[0];
            CHECK(map_quality(before.mesh, before.map).flipped_triangles == 0);
            CHECK(map_quality(mesh, map).flipped_triangles == 0);
            CHECK(mesh_quality(mesh).flipped_faces == 0);
            const double whole = area_of_faces(folded.levels[0].mesh) - area_of_faces(before.mesh);
            CAPTURE(density);
            // In an image of noise most cells are as thin as they may be, so that little can move.
            CHECK(area_of_faces(mesh) - area_of_faces(before.mesh) >= (mask == &disc ? 0.15 : 0.1) * whole);
        }
    }
}

TEST_CASE("outer edge: whole images are covered to their sides without a fold") {
    for (const std::uint32_t seed : {1u, 2u, 3u, 4u, 5u, 6u})
        for (const double density : {0.5, 4.0, 30.0, 100.0}) {
            const int width = 20 + 17 * static_cast<int>(seed), height = 90 - 13 * static_cast<int>(seed);
            MeshImage m = built(random_image(width, height, seed), {}, density);
            extend_to_outer_edge(m);
            const auto& [mesh, map, error] = m.levels[0];
            CAPTURE(seed);
            CAPTURE(density);
            CHECK(area_of_faces(mesh) == width * height);
            CHECK(map_quality(mesh, map).flipped_triangles == 0);
            CHECK(mesh_quality(mesh).flipped_faces == 0);
        }
    for (const auto& [width, height] : {std::pair{1, 1}, std::pair{1, 9}, std::pair{9, 1}, std::pair{2, 3}}) {
        MeshImage m = built(random_image(width, height, 2), {}, 100);
        extend_to_outer_edge(m);
        CHECK(area_of_faces(m.levels[0].mesh) == width * height);
    }
}
