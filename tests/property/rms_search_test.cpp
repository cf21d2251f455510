// The search for an error, on artificial errors and in the whole pipeline.
#include <doctest/doctest.h>
#include <optional>

#include <cmath>
#include <functional>

#include "libcore/base/error.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/lod_meshes.h"
#include "libcore/pipeline/rms_search.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// Errors of an artificial image.
class MadeUpMeshes : public MeasuredMeshes {
  public:
    std::function<double(std::int64_t)> error;
    double estimate = 1;     // what estimates are off by
    std::int64_t least = 4;  // no mesh is coarser
    int finishes = 0, estimates = 0;
    std::int64_t last = 0, kept = 0;

    Probe finished(std::int64_t vertices) override {
        ++finishes;
        last = std::max(least, vertices);
        return {last, error(last)};
    }
    void keep() override { kept = last; }
    Probe estimated(std::int64_t vertices) override {
        ++estimates;
        const std::int64_t n = std::max(least, vertices);
        return {n, estimate * error(n)};
    }
};

}  // namespace

// Errors like those of photographs: they fall with a power of the number of vertices.
TEST_CASE("rms search: as few vertices as the error allows, found with few meshes") {
    for (const std::int64_t vertices : {4, 5, 100, 400'000, 100'000'000})
        for (const double rms : {0.0, 0.01, 0.5, 2.0, 7.0, 1e9})
            for (const double slope : {0.35, 0.5, 0.7})
                for (const double off : {0.85, 1.0, 1.2}) {
                    INFO(vertices << " vertices, RMS " << rms << " slope " << slope << " off " << off);
                    MadeUpMeshes meshes;
                    meshes.error = [slope](std::int64_t n) { return 300 * std::pow(double(n), -slope); };
                    meshes.estimate = off;
                    const bool found = search_rms(vertices, vertices / 50, rms, meshes);
                    CHECK(meshes.estimates <= 2);
                    CHECK(found == (meshes.error(vertices) <= rms));
                    CHECK(found == (meshes.kept > 0));
                    // Searches that end only at the densest or the coarsest mesh, or start far from the goal,
                    // take a few more.
                    CHECK(meshes.finishes <= 8);
                    if (!found) continue;
                    CHECK(meshes.error(meshes.kept) <= rms);
                    if (meshes.kept == 4) continue;
                    CHECK(meshes.error(static_cast<std::int64_t>(0.94 * double(meshes.kept)) - 1) > rms);
                    const double share = double(meshes.kept) / double(vertices);
                    if (share > 0.002 && share < 0.1 && meshes.kept > 100) CHECK(meshes.finishes <= 3);
                }
}

// An edge that needs a certain number of vertices, errors that rise and fall, and no error at all.
TEST_CASE("rms search: errors that follow no law") {
    MadeUpMeshes jump;
    jump.error = [](std::int64_t n) { return n >= 777 ? 1.0 : 30.0; };
    REQUIRE(search_rms(100'000, 1000, 2, jump));
    CHECK(jump.kept >= 777);
    CHECK(jump.kept <= 810);
    CHECK(jump.finishes <= 30);

    MadeUpMeshes rough;
    rough.error = [](std::int64_t n) { return 300 / std::sqrt(double(n)) * (1 + 0.3 * std::sin(double(n))); };
    REQUIRE(search_rms(100'000, 1000, 5, rough));
    CHECK(rough.error(rough.kept) <= 5);
    CHECK(rough.finishes <= 30);

    MadeUpMeshes flat;
    flat.error = [](std::int64_t) { return 0.0; };
    REQUIRE(search_rms(100'000, 1000, 0, flat));
    CHECK(flat.kept == 4);
    CHECK(flat.finishes <= 3);

    // No mesh is coarser than 600: limits of the collapse end it there.
    MadeUpMeshes limited;
    limited.least = 600;
    limited.error = [](std::int64_t n) { return 300 / std::sqrt(double(n)); };
    REQUIRE(search_rms(100'000, 1000, 50, limited));
    CHECK(limited.kept == 600);
    CHECK(limited.finishes <= 3);
    REQUIRE(search_rms(100'000, 1000, 7, limited));
    CHECK(limited.error(limited.kept) <= 7);
}

// The returned mesh is the requested one. Slightly finer ones are kept; others need a new collapse.
TEST_CASE("mesh lods: meshes of any number of vertices, from as few runs as possible") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 150, 120);
    const GridMesh grid = grid_mesh(feature);
    const auto params = [](std::int64_t) { return plain_params(); };
    const Progress none;
    LodMeshes lods(grid, params, none);
    const auto count = [&](std::int64_t vertices, bool near) {
        const SimplifyResult level = lods.mesh(vertices, near);
        CHECK(level.mesh.faces.size() > 0);
        return static_cast<std::int64_t>(level.mesh.vertex_count());
    };
    CHECK(count(5000, false) == 5000);
    CHECK(count(900, false) == 900);
    CHECK(count(600, true) == 600);
    CHECK(lods.runs() == 1);
    for (const std::int64_t finer : {600, 601, 650, 700, 790}) {
        CHECK(count(finer, true) <= finer);
        CHECK(count(finer, true) >= 0.98 * double(finer) - 1);
    }
    CHECK(count(590, true) <= 590);
    CHECK(lods.runs() == 1);
    CHECK(count(2000, true) == 2000);
    CHECK(lods.runs() == 2);
    CHECK(count(4, true) == 4);
}

// A strip one pixel wide has more vertices than pixels: with all of them the image is reached exactly.
TEST_CASE("build: a wanted RMS is reached on strips") {
    BuildParams params;
    params.stop.rms = 0.1;
    const Image strip = sample_picture(Kind::kNoise, 9, 1);
    CHECK(build_mesh_image(strip, params).report.levels.front().map_rms <= 0.1);
    const Image image = sample_picture(Kind::kNoise, 24, 16);
    Mask columns{24, 16, std::vector<std::uint8_t>(24 * 16, 0)};
    for (std::size_t i = 0; i < columns.size(); i += 2) columns[i] = 1;
    CHECK(build_mesh_image(image, params, {}, columns).report.levels.front().map_rms <= 0.1);
}

TEST_CASE("build: a wanted RMS is kept, closely") {
    for (const Kind kind : {Kind::kGradient, Kind::kDisc, Kind::kNoise}) {
        const Image image = sample_picture(kind, 90, 70);
        std::size_t before = 0;
        for (const double rms : {40.0, 12.0, 3.0}) {
            INFO(name_of(kind) << " RMS " << rms);
            BuildParams params;
            params.stop.rms = rms;
            const BuildResult built = build_mesh_image(image, params);
            CHECK(built.report.levels.front().map_rms <= rms);
            const std::size_t vertices = built.mesh_image.levels.front().mesh.vertex_count();
            CHECK(vertices >= before);
            before = vertices;
            // A tenth fewer vertices are too few; with a single edge in the image, errors do not rise
            // steadily.
            if (vertices < 40 || kind == Kind::kDisc) continue;
            BuildParams fewer;
            fewer.stop.vertices = static_cast<std::int64_t>(0.9 * double(vertices));
            CHECK(build_mesh_image(image, fewer).report.levels.front().map_rms > 0.97 * rms);
        }
    }
}

TEST_CASE("build: an RMS below 0 is refused") {
    BuildParams params;
    params.stop.rms = -1;
    CHECK_THROWS_AS(build_mesh_image(sample_picture(Kind::kNoise, 12, 9), params), Error);
}
