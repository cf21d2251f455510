// The search for an error, on errors made up, and in the whole pipeline.
#include <doctest/doctest.h>

#include <cmath>

#include "libcore/base/error.h"
#include "libcore/build/build.h"
#include "libcore/build/rms_search.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

// Errors like those of photographs: they fall with a power of the number of vertices.
TEST_CASE("rms search: as few vertices as the error allows, found with few measurements") {
    for (const std::int64_t vertices : {4, 5, 100, 400'000, 100'000'000})
        for (const double rms : {0.0, 0.01, 0.5, 2.0, 7.0, 1e9}) {
            INFO(vertices << " vertices, RMS " << rms);
            const auto error_of = [](std::int64_t n) { return 300 / std::sqrt(double(n)); };
            int runs = 0, measured = 0;
            std::int64_t last = 0, found = 0;
            search_rms(
                vertices, rms,
                [&](const std::vector<std::int64_t>& counts) {
                    ++runs;
                    for (std::size_t k = 1; k < counts.size(); ++k) CHECK(counts[k] < counts[k - 1]);
                    CHECK(counts.back() >= 4);
                    return [&, counts](std::size_t k) {
                        ++measured;
                        last = counts[k];
                        return error_of(last);
                    };
                },
                [&] { found = last; });
            CHECK(runs <= 2);
            CHECK(measured <= 24);
            if (error_of(vertices) > rms) {
                CHECK(found == 0);
                continue;
            }
            REQUIRE(found >= 4);
            CHECK(error_of(found) <= rms);
            if (found > 4) CHECK(error_of(static_cast<std::int64_t>(0.95 * double(found)) - 1) > rms);
        }
}

// A strip one pixel wide has more vertices than pixels: with all of them the picture is reached exactly.
TEST_CASE("build: a wanted RMS is reached on strips") {
    BuildParams params;
    params.stop.rms = 0.1;
    const Image strip = sample_picture(Kind::kNoise, 9, 1);
    CHECK(build_mesh_image(strip, params).report.levels.front().map_rms <= 0.1);
    const Image image = sample_picture(Kind::kNoise, 24, 16);
    Mask columns{24, 16, std::vector<std::uint8_t>(24 * 16, 0)};
    for (std::size_t i = 0; i < columns.inside.size(); i += 2) columns.inside[i] = 1;
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
            // A tenth fewer vertices are too few; with a single edge in the picture, errors do not rise
            // steadily.
            if (vertices < 40 || kind == Kind::kDisc) continue;
            BuildParams fewer;
            fewer.stop.vertices = static_cast<std::int64_t>(0.9 * double(vertices));
            CHECK(build_mesh_image(image, fewer).report.levels.front().map_rms > 0.97 * rms);
        }
    }
}

TEST_CASE("build: an RMS that no mesh has is refused, and so are negative ones") {
    const Image image = sample_picture(Kind::kNoise, 12, 9);
    const auto code = [&](double rms) {
        BuildParams params;
        params.stop.rms = rms;
        try {
            build_mesh_image(image, params);
        } catch (const Error& error) {
            return error.code();
        }
        return ErrorCode::kOk;
    };
    CHECK(code(0) == ErrorCode::kUnsupported);
    CHECK(code(-1) == ErrorCode::kUsage);
    CHECK(code(0.1) == ErrorCode::kOk);
}
