// The whole pipeline: bad arguments, odd images, and figures that can be measured again.
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/pipeline/build.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::optional<ErrorKind> failure(const Image& image, const BuildParams& params) {
    try {
        build_mesh_image(image, params);
    } catch (const Error& error) {
        CHECK(std::string(error.what()).find('\n') == std::string::npos);
        return error.kind();
    }
    return std::nullopt;
}

void check_sound(const MeshImage& built, const Image& image) {
    REQUIRE(built.levels.size() == 1);
    const auto& [mesh, map, error] = built.levels[0];
    CHECK(map.width == image.width);
    CHECK(map.height == image.height);
    CHECK(map.size() == image.pixel_count());
    const MeshQuality q = mesh_quality(mesh);
    CHECK(q.euler == 1);
    CHECK(q.nonmanifold_edges + q.nonmanifold_vertices + q.flipped_faces == 0);
    CHECK(q.area == double(std::max(1, image.width - 1)) * std::max(1, image.height - 1));
    const MapQuality m = map_quality(mesh, map);
    CHECK(m.unmapped + m.outside_simplex + m.flipped_triangles == 0);
    for (const float f : mesh.feature) CHECK(std::isfinite(f));
    CHECK(std::isfinite(error));
}

bool same(const Level& a, const Level& b) {
    return a.mesh.position == b.mesh.position && a.mesh.feature == b.mesh.feature &&
           a.mesh.faces == b.mesh.faces && a.map.values == b.map.values &&
           a.map.precision == b.map.precision && a.error == b.error;
}

BuildParams with_density(double density) {
    BuildParams params;
    params.stop.density = density;
    return params;
}

}  // namespace

TEST_CASE("build: every parameter out of range is refused as wrong use") {
    const Image image = sample_picture(Kind::kDisc, 8, 8);
    for (const std::int64_t faces : {-1, 0, 1}) {
        BuildParams p;
        p.stop.faces = faces;
        CHECK(failure(image, p) == ErrorKind::kBadArgument);
    }
    for (const std::int64_t vertices : {-7, 0, 3}) {
        BuildParams p;
        p.stop.vertices = vertices;
        CHECK(failure(image, p) == ErrorKind::kBadArgument);
    }
    for (const double error : {-1.0, kNan, kInfinity}) {
        BuildParams p;
        p.stop.error = error;
        CHECK(failure(image, p) == ErrorKind::kBadArgument);
    }
    for (const double density : {0.0, -1.0, 100.5, kNan, kInfinity})
        CHECK(failure(image, with_density(density)) == ErrorKind::kBadArgument);
    for (const double weight : {0.0, -1.0, kNan, kInfinity}) {
        BuildParams geometry, color;
        geometry.geometry_weight = weight;
        color.color_weight = weight;
        CHECK(failure(image, geometry) == ErrorKind::kBadArgument);
        CHECK(failure(image, color) == ErrorKind::kBadArgument);
    }
    for (const double weight : {-1e-9, -1.0, kNan, kInfinity}) {
        BuildParams p;
        p.projection_color_weight = weight;
        CHECK(failure(image, p) == ErrorKind::kBadArgument);
    }
    CHECK(failure(Image{}, {}) == ErrorKind::kBadArgument);
}

TEST_CASE("build: what is in range works, to its very ends") {
    const Image image = sample_picture(Kind::kNoise, 24, 18);
    std::vector<BuildParams> all(9);
    all[0].stop.faces = 2;
    all[1].stop.vertices = 4;
    all[2].stop.vertices = 1'000'000'000'000;
    all[3].stop.error = 0;
    all[4].stop.density = 100;
    all[5].stop.density = 1e-300;
    all[6].projection_color_weight = 1e300;
    all[7].projection_color_weight = 1e-300;
    all[8].bary = WeightPrecision::kFloat;
    for (std::size_t k = 0; k < all.size(); ++k) {
        INFO("case " << k);
        check_sound(build_mesh_image(image, all[k]).mesh_image, image);
    }
}

// Only the ratio of the two weights counts; one that single precision cannot hold is refused.
TEST_CASE("build: the ratio of geometry and color weight") {
    const Image image = sample_picture(Kind::kNoise, 24, 18);
    const auto with = [](double geometry, double color) {
        BuildParams p = with_density(10);
        p.geometry_weight = geometry;
        p.color_weight = color;
        return p;
    };
    const Level one = build_mesh_image(image, with(3, 1)).mesh_image.levels[0],
                other = build_mesh_image(image, with(12, 4)).mesh_image.levels[0];
    CHECK(one.mesh.position == other.mesh.position);
    CHECK(one.map.values == other.map.values);
    CHECK(other.error == doctest::Approx(4 * one.error));
    for (const double ratio : {1e-6, 1e6})
        check_sound(build_mesh_image(image, with(ratio, 1)).mesh_image, image);
    for (const auto& [geometry, color] :
         {std::pair{1e300, 1e-300}, {1e-300, 1e300}, {1e-40, 1.0}, {1e30, 1.0}})
        CHECK(failure(image, with(geometry, color)) == ErrorKind::kBadArgument);
}

TEST_CASE("build: an error limit counts in the weights' own units") {
    const Image image = sample_picture(Kind::kNoise, 24, 18);
    for (const double color_weight : {1.0, 10.0}) {
        BuildParams p;
        p.stop.error = 2e4;
        p.color_weight = color_weight;
        const BuildResult built = build_mesh_image(image, p);
        CHECK(built.report.collapses > 0);
        CHECK(built.mesh_image.levels[0].error <= 2e4);
        CHECK(built.mesh_image.levels[0].error > 0);
    }
}

TEST_CASE("build: all kinds and sizes of images") {
    for (const Kind kind : kAllKinds)
        for (const auto& [w, h] :
             {std::pair{1, 1}, {1, 2}, {2, 1}, {2, 2}, {1, 30}, {30, 1}, {3, 3}, {5, 7}, {40, 30}}) {
            INFO(name_of(kind) << " " << w << " x " << h);
            const Image image = sample_picture(kind, w, h);
            const MeshImage built = build_mesh_image(image, with_density(5)).mesh_image;
            check_sound(built, image);
            CHECK(built.source.width == w);
            CHECK(built.source.height == h);
        }
}

TEST_CASE("build: grey is colour with equal channels, and alpha is ignored") {
    Image grey = make_image(20, 16, 1), color = make_image(20, 16, 3), alpha = make_image(20, 16, 4);
    for (std::size_t i = 0; i < grey.data.size(); ++i) {
        const float value = static_cast<float>(i * 37 % 256) / 255;
        grey.data[i] = value;
        std::fill_n(&color.data[3 * i], 3, value);
        std::fill_n(&alpha.data[4 * i], 3, value);
        alpha.data[4 * i + 3] = static_cast<float>(i % 2);
    }
    const MeshImage expected = build_mesh_image(color, with_density(10)).mesh_image;
    const MeshImage from_grey = build_mesh_image(grey, with_density(10)).mesh_image;
    CHECK(same(from_grey.levels[0], expected.levels[0]));
    CHECK(same(build_mesh_image(alpha, with_density(10)).mesh_image.levels[0], expected.levels[0]));
    CHECK(from_grey.source.channel_names == std::vector<std::string>{"Y"});
    CHECK(expected.source.channel_names == std::vector<std::string>{"R", "G", "B"});
}

TEST_CASE("build: images without colour, or with samples that are none, are not supported") {
    Image depth = make_image(4, 4, 1);
    depth.channel_names = {"Z"};
    CHECK(failure(depth, {}) == ErrorKind::kUnsupported);
    CHECK(failure(make_image(4, 4, 5), {}) == ErrorKind::kUnsupported);
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
        Image image = sample_picture(Kind::kDisc, 6, 6);
        image.pixel(2, 3)[1] = static_cast<float>(bad);
        CHECK(failure(image, {}) == ErrorKind::kUnsupported);
    }
}

TEST_CASE("build: every colour space, and values far outside of [0, 1]") {
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kLinear, ColorSpace::kRec709,
                                   ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3})
        for (const float scale : {1.0f, -1.0f, 1e-6f, 1e3f, 1e12f}) {
            INFO(std::string(color_space_name(space)) << ", times " << scale);
            Image image = sample_picture(Kind::kNoise, 16, 12);
            image.color_space = space;
            for (float& sample : image.data) sample *= scale;
            const MeshImage built = build_mesh_image(image, with_density(10)).mesh_image;
            check_sound(built, image);
            CHECK(built.source.color_space == space);
        }
}

TEST_CASE("build: the report's figures are those of what a reader gets") {
    for (const Kind kind : kAllKinds) {
        const Image image = sample_picture(kind, 40, 30);
        const BuildResult built = build_mesh_image(image, with_density(5));
        const auto& [mesh, map, error] = built.mesh_image.levels[0];
        const FeatureImage feature = luv_image(image);
        CHECK(built.report.levels.front().map_rms == map_rms(mesh, map, feature));
        CHECK(built.report.levels.front().gouraud_rms == map_rms(mesh, trivial_map(mesh, 40, 30), feature));
        CHECK(built.report.collapses == 40 * 30 - static_cast<std::int64_t>(mesh.vertex_count()));
        CHECK(mesh.vertex_count() == 60);
    }
}

TEST_CASE("build: what shaped the result is listed, and only that") {
    const Image image = sample_picture(Kind::kDisc, 20, 20);
    const auto listed = [&](const BuildParams& params, const std::string& name) {
        for (const auto& [key, value] : build_mesh_image(image, params).mesh_image.parameters)
            if (key == name) return true;
        return false;
    };
    BuildParams by_faces;
    by_faces.stop.faces = 50;
    CHECK(listed(by_faces, "faces"));
    CHECK_FALSE(listed(by_faces, "density"));
    CHECK(listed({}, "density"));
    CHECK_FALSE(listed({}, "faces"));
    for (const char* name : {"metric", "geometry-weight", "color-weight", "projection-color-weight", "bary"})
        CHECK(listed({}, name));
}

TEST_CASE("build: the same result for any number of threads") {
    const Image image = sample_picture(Kind::kNoise, 60, 80);
    const Level first = build_mesh_image(image, with_density(5)).mesh_image.levels[0];
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        CHECK(same(build_mesh_image(image, with_density(5)).mesh_image.levels[0], first));
    }
}

TEST_CASE("build: progress rises from 0 to 1") {
    double last = 0;
    build_mesh_image(sample_picture(Kind::kDisc, 60, 50), {}, [&](double fraction, std::string_view stage) {
        CHECK(fraction >= last);
        CHECK(!stage.empty());
        last = fraction;
    });
    CHECK(last == 1);
}

TEST_CASE("build: an image that is given away has no samples any more, and the same mesh") {
    Image image = sample_picture(Kind::kNoise, 50, 40);
    const Level expected = build_mesh_image(image, with_density(10)).mesh_image.levels[0];
    CHECK(image.data.size() == image.sample_count());
    CHECK(same(build_mesh_image(std::move(image), with_density(10)).mesh_image.levels[0], expected));
    CHECK(image.data.empty());  // NOLINT(bugprone-use-after-move): what this is about
}

// L*u*v* of negative linear RGB has no bound, so one unclipped sample would outweigh the whole image.
TEST_CASE("build: light below 0 is clipped, and above 1 too in images of integers") {
    Image clipped = make_image(24, 18, 3);
    clipped.color_space = ColorSpace::kLinear;
    clipped.sample_type = SampleType::kUint16;
    for (std::size_t i = 0; i < clipped.data.size(); ++i)
        clipped.data[i] = static_cast<float>(i * 7 % 11) / 10.0f;
    Image wild = clipped;
    for (float& sample : wild.data) {
        if (sample == 0.0f) sample = -3e38f;
        if (sample == 1.0f) sample = 1e30f;
    }
    const BuildResult expected = build_mesh_image(clipped, {}), built = build_mesh_image(wild, {});
    CHECK(built.report.levels.front().map_rms == expected.report.levels.front().map_rms);
    CHECK(built.mesh_image.levels.front().mesh.feature == expected.mesh_image.levels.front().mesh.feature);
}
