// What was asked for in numbers is reached, or told.
#include <doctest/doctest.h>

#include "libcore/base/error.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/presets.h"
#include "libcore/pipeline/targets.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;
using Lines = std::vector<std::string>;

namespace {

struct Built {
    std::size_t levels;
    std::int64_t faces, vertices;
    Lines missed;
};

Built build(const Image& image, const BuildParams& params, const Mask& mask = {}, bool density = true) {
    const BuildResult result = build_mesh_image(image, params, {}, mask);
    const BaseMesh& mesh = result.mesh_image.levels[0].mesh;
    CHECK(result.report.levels.size() == result.mesh_image.levels.size());
    return {result.mesh_image.levels.size(), std::ssize(mesh.faces),
            static_cast<std::int64_t>(mesh.vertex_count()), missed_targets(params, result, density)};
}

BuildParams faces(std::int64_t number) {
    BuildParams params;
    params.stop.faces = number;
    return params;
}
BuildParams vertices(std::int64_t number) {
    BuildParams params;
    params.stop.vertices = number;
    return params;
}

}  // namespace

TEST_CASE("targets: numbers of faces and vertices, reached to one collapse") {
    const Image image = sample_picture(Kind::kNoise, 10, 10);
    for (const std::int64_t number : {2, 3, 4, 5, 20, 21, 100, 161, 162}) {
        INFO(number);
        const Built built = build(image, faces(number));
        CHECK(built.missed == Lines{});
        CHECK(number - built.faces >= 0);
        CHECK(number - built.faces <= 1);
    }
    CHECK(build(image, faces(163)).missed == Lines{});  // one less is what a collapse leaves
    CHECK(build(image, faces(5000)).missed ==
          Lines{"5000 faces were wanted, the mesh of all pixels has 162"});
    for (const std::int64_t number : {4, 5, 37, 100}) {
        const Built built = build(image, vertices(number));
        CHECK(built.missed == Lines{});
        CHECK(built.vertices == number);
    }
    CHECK(build(image, vertices(101)).missed ==
          Lines{"101 vertices were wanted, the mesh of all pixels has 100"});
    // Of two limits one is enough, and an error always holds.
    BuildParams both = faces(5000);
    both.stop.vertices = 20;  // not even tried, as there are no more than 5000 faces
    CHECK(build(image, both).missed == Lines{"5000 faces were wanted, the mesh of all pixels has 162"});
    both = faces(100);
    both.stop.vertices = 20;
    CHECK(build(image, both).missed == Lines{});
    both = faces(4);
    both.stop.error = 1e-3;
    CHECK(build(image, both).missed == Lines{});
}

// Corners, sides and pixels alone leave little to collapse.
TEST_CASE("targets: tiny images") {
    for (const auto& [width, height, dense] :
         {std::tuple(1, 1, 2), std::tuple(3, 3, 8), std::tuple(1, 7, 12)}) {
        const Image image = sample_picture(Kind::kNoise, width, height);
        CHECK(build(image, {}).missed == Lines{});
        CHECK(build(image, faces(2)).missed == Lines{});
        const Built many = build(image, faces(5000));
        CHECK(many.faces == dense);
        CHECK(many.missed == Lines{cat("5000 faces were wanted, the mesh of all pixels has ", dense)});
    }
}

TEST_CASE("targets: refinement keeps the numbers, whatever the preset") {
    const Image image = sample_picture(Kind::kNoise, 24, 18);
    for (const Preset& preset : presets())
        for (const std::int64_t number : {40, 300}) {
            INFO(preset.name << " " << number);
            BuildParams params = preset.params;
            params.stop.faces = number;
            const Built built = build(image, params);
            if (params.min_quality == 0) {
                CHECK(built.missed == Lines{});
                CHECK(number - built.faces <= 1);
            } else if (built.faces > number) {  // a bound on shapes may want more
                CHECK(built.missed == Lines{cat(number, " faces were wanted, ", built.faces,
                                                " are the fewest that min-quality 0.28 allows")});
            }
        }
}

TEST_CASE("targets: levels alike are one") {
    const Image image = sample_picture(Kind::kNoise, 10, 10);
    BuildParams params;
    params.levels.faces = {8000, 2000, 50};
    Built built = build(image, params);
    CHECK(built.levels == 2);
    CHECK(built.missed == Lines{"8000 faces were wanted, the mesh of all pixels has 162",
                                "level 1 would be the same as level 0 and is left out"});
    params.levels.faces = {150, 50, 8};
    CHECK(build(image, params).missed == Lines{});
    params.levels = {};
    params.levels.errors = {1e9, 2e9, 3e9};
    built = build(image, params);
    CHECK(built.levels == 1);
    CHECK(built.missed == Lines{"levels 1 to 2 would be the same as level 0 and are left out"});
    for (const MapKind map : {MapKind::kRelaxed, MapKind::kTracked, MapKind::kTrivial}) {
        params = faces(100);
        params.levels.count = 8;  // 100, 25, 6, 2
        params.map = map;
        built = build(image, params);
        CHECK(built.levels == 4);
        CHECK(built.missed == Lines{"levels 4 to 7 would be the same as level 3 and are left out"});
    }
    params = faces(100);
    params.levels.count = 3;
    CHECK(build(image, params).missed == Lines{});
}

// Each island keeps a face of its own.
TEST_CASE("targets: what a mask and other bounds do not allow") {
    const Image image = sample_picture(Kind::kNoise, 12, 12);
    Mask mask(12, 12, std::vector<std::uint8_t>(144, 0));
    for (int y = 0; y < 12; y += 4)
        for (int x = 0; x < 12; x += 4)
            for (int k = 0; k < 4; ++k) mask.row(y + k / 2)[static_cast<std::size_t>(x + k % 2)] = 1;
    const Built built = build(image, faces(2), mask);
    CHECK(built.faces >= 9);
    CHECK(built.missed ==
          Lines{cat("2 faces were wanted, ", built.faces, " are the fewest that the mask's outline allows")});
    // The default is nothing that was asked for.
    CHECK(build(image, {}, mask, false).missed == Lines{});
    CHECK(build(image, {}, mask, true).missed.size() == 1);
    BuildParams params = faces(2);
    params.max_cluster = 9;
    CHECK(build(image, params).missed.size() == 1);
}

TEST_CASE("targets: an error that no mesh has") {
    const Image image = sample_picture(Kind::kNoise, 12, 9);
    BuildParams params;
    params.stop.rms = 0;
    const Built built = build(image, params);
    CHECK(built.vertices == 108);  // the best that there is
    REQUIRE(built.missed.size() == 1);
    CHECK(built.missed[0].starts_with("an RMS error of 0 was wanted, the mesh of all pixels has "));
    params.stop.rms = 10;
    CHECK(build(image, params).missed == Lines{});
}
