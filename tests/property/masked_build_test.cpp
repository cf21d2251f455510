// The whole pipeline on masked images.
#include <doctest/doctest.h>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

std::optional<ErrorKind> failure(const Image& image, const Mask& mask) {
    try {
        build_mesh_image(image, {}, {}, mask);
    } catch (const Error& error) {
        return error.kind();
    }
    return std::nullopt;
}

bool same(const Level& a, const Level& b) {
    return a.mesh.position == b.mesh.position && a.mesh.feature == b.mesh.feature &&
           a.mesh.faces == b.mesh.faces && a.map.values == b.map.values;
}

}  // namespace

TEST_CASE("masked images: masks that do not fit, or have nothing inside, are refused") {
    const Image image = sample_picture(Kind::kDisc, 9, 7);
    CHECK(failure(image, mask_where(9, 7, [](int, int) { return false; })) == ErrorKind::kUnsupported);
    CHECK(failure(image, mask_where(7, 9, [](int, int) { return true; })) == ErrorKind::kBadFile);
}

TEST_CASE("masked images: a mask with all pixels inside gives what none gives") {
    const Image image = sample_picture(Kind::kNoise, 40, 30);
    const BuildResult with =
                          build_mesh_image(image, {}, {}, mask_where(40, 30, [](int, int) { return true; })),
                      without = build_mesh_image(image, {});
    CHECK(same(with.mesh_image.levels[0], without.mesh_image.levels[0]));
    CHECK_FALSE(with.mesh_image.source.has_mask);
    CHECK(with.report.pixels == 1200);
}

TEST_CASE("masked images: percents are of the pixels inside") {
    const Mask mask = mask_where(100, 80, [](int x, int y) { return x < 50 && y < 40; });
    BuildParams params;
    params.stop.density = 5;
    const BuildResult built = build_mesh_image(sample_picture(Kind::kNoise, 100, 80), params, {}, mask);
    CHECK(built.report.pixels == 2000);
    CHECK(built.mesh_image.levels[0].mesh.vertex_count() == 100);
    CHECK(built.mesh_image.source.has_mask);
}

TEST_CASE("masked images: every level has the mask, no fold, and no more pixels a face than allowed") {
    for (const auto& [name, mask] : sample_masks(36)) {
        INFO(name);
        BuildParams params;
        params.stop.density = 20;
        params.levels.count = 3;
        params.max_cluster = 30;
        const BuildResult built =
            build_mesh_image(sample_picture(Kind::kDisc, mask.width, mask.height), params, {}, mask);
        const std::int64_t inside = mask.count();
        CHECK(built.report.pixels == inside);
        for (const Level& level : built.mesh_image.levels) {
            const MapQuality q = map_quality(level.mesh, level.map, true);
            CHECK(q.pixels == inside);
            CHECK(q.unmapped + q.outside_simplex + q.flipped_triangles == 0);
            std::vector<int> pixels(level.mesh.faces.size());
            for (const PixelCoord& coord : level.map)
                if (coord.face != kNone && ++pixels[coord.face] > 30) FAIL("a face with more than 30 pixels");
        }
    }
}

TEST_CASE("masked images: the same result for any number of threads") {
    const Mask mask = sample_masks(90)[4].mask;
    const Image image = sample_picture(Kind::kNoise, 90, 90);
    const Level first = build_mesh_image(image, {}, {}, mask).mesh_image.levels[0];
    for (const int threads : {1, 3}) {
        const ThreadLimit limit(threads);
        CHECK(same(build_mesh_image(image, {}, {}, mask).mesh_image.levels[0], first));
    }
}
