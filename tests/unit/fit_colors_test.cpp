#include <doctest/doctest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <random>

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/color_sums.h"
#include "libcore/param/fit_colors.h"
#include "libcore/param/fit_map.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/meshes.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// The trivial map with every pixel's weights turned towards the middle of its face: another valid map.
PixelMap towards_middle(PixelMap map) {
    for (PixelCoord& coord : map) {
        coord.u = 0.5f * coord.u + 1.0f / 6;
        coord.v = 0.5f * coord.v + 1.0f / 6;
    }
    return map;
}

// The unconstrained solution by a dense solver: one row of three weights a pixel and term.
Eigen::MatrixXd dense_solution(const BaseMesh& mesh, const FeatureImage& feature,
                               const std::vector<FitTerm>& terms) {
    const auto vertices = static_cast<Eigen::Index>(mesh.vertex_count());
    const auto pixels = static_cast<Eigen::Index>(feature.pixel_count());
    const auto rows = pixels * static_cast<Eigen::Index>(terms.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(rows, vertices), b(rows, 3);
    Eigen::Index row = 0;
    for (const FitTerm& term : terms)
        for (std::size_t i = 0; i < term.map->size(); ++i, ++row) {
            const PixelCoord& coord = (*term.map)[i];
            const double root = std::sqrt(term.weight);
            const double w[3] = {1.0 - double(coord.u) - double(coord.v), double(coord.u), double(coord.v)};
            for (std::size_t k = 0; k < 3; ++k) a(row, mesh.faces[coord.face][k]) += root * w[k];
            for (int c = 0; c < 3; ++c) b(row, c) = root * double(feature.pixel(i)[c]);
        }
    return (a.transpose() * a).ldlt().solve(a.transpose() * b);
}

BaseMesh collapsed(const FeatureImage& feature, std::int64_t vertices) {
    return simplify(grid_mesh(feature), plain_params(), SimplifyTarget{.vertices = vertices}).mesh;
}

double objective(const BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms) {
    double sum = 0;
    for (const FitTerm& term : terms) {
        const double rms = map_rms(mesh, *term.map, feature);
        sum += term.weight * rms * rms;
    }
    return sum;
}

}  // namespace

TEST_CASE("fit colours: where the gamut does not matter, the dense least-squares solution") {
    Image image = sample_picture(Kind::kGradient, 20, 15);
    for (float& sample : image.data) sample = 0.35f + 0.3f * sample;  // away from the gamut's surface
    const FeatureImage feature = luv_image(image);
    BaseMesh mesh = jittered_grid(0, 0, 19, 14, 3, 3, 7);
    const PixelMap trivial = trivial_map(mesh, 20, 15), other = towards_middle(trivial);
    const std::vector<FitTerm> terms{{&other, 0.7}, {&trivial, 0.3}};
    const Eigen::MatrixXd expected = dense_solution(mesh, feature, terms);
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f luv = expected.row(v).transpose().cast<float>();
        REQUIRE(in_gamut(luv) == luv);
        std::copy_n(Vec3f(50, 0, 0).data(), 3, mesh.feature_of(v));
    }
    // It iterates: repeated calls from its last result come arbitrarily close.
    for (int n = 0; n < 8; ++n) fit_colors(mesh, feature, terms);
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        for (int c = 0; c < 3; ++c)
            CHECK(double(mesh.feature_of(v)[c]) == doctest::Approx(expected(v, c)).epsilon(2e-3));
}

TEST_CASE("fit colours: a vertex that no pixel touches keeps its value") {
    BaseMesh mesh = jittered_grid(0, 0, 9, 9, 2, 2, 1);
    mesh.position.push_back({4, 4});
    mesh.feature.insert(mesh.feature.end(), {33, 4, 5});
    const PixelMap map = trivial_map(mesh, 10, 10);
    fit_colors(mesh, sample_feature(Kind::kDisc, 10, 10), {{&map, 1.0}});
    CHECK(Vec3f(mesh.feature_of(static_cast<Id>(mesh.vertex_count() - 1))) == Vec3f(33, 4, 5));
}

TEST_CASE("fit colours: pixels outside the mask do not count") {
    BaseMesh mesh = jittered_grid(0, 0, 9, 9, 2, 2, 1);
    FeatureImage feature = sample_feature(Kind::kConstant, 10, 10);
    PixelMap map = trivial_map(mesh, 10, 10);
    for (std::size_t i = 0; i < map.size(); i += 7) {
        map[i] = {};
        feature.pixel(i)[0] = 1e6f;
    }
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        std::copy_n(feature.pixel(std::size_t{1}), 3, mesh.feature_of(v));
    const std::vector<float> before = mesh.feature;
    fit_colors(mesh, feature, {{&map, 1.0}});
    for (std::size_t k = 0; k < before.size(); ++k)
        CHECK(mesh.feature[k] == doctest::Approx(before[k]).epsilon(1e-5));
}

TEST_CASE("fit colours: never worse than before, from any colours of the gamut") {
    std::mt19937 random(3);
    for (const Kind kind : kAllKinds) {
        const FeatureImage feature = sample_feature(kind, 24, 18);
        for (const std::int64_t vertices : {6, 40}) {
            BaseMesh mesh = collapsed(feature, vertices);
            const PixelMap trivial = trivial_map(mesh, 24, 18), other = towards_middle(trivial);
            const std::vector<FitTerm> terms{{&other, 0.9}, {&trivial, 0.1}};
            for (int start = 0; start < 3; ++start) {
                INFO(name_of(kind) << ", " << vertices << " vertices, start " << start);
                for (Id v = 0; v < mesh.vertex_count(); ++v) {
                    Vec3f luv = start == 0 ? Vec3f(mesh.feature_of(v))
                                           : Vec3f(static_cast<float>(random() % 100),
                                                   static_cast<float>(random() % 100),
                                                   static_cast<float>(random() % 100));
                    luv = in_gamut(luv);
                    std::copy_n(luv.data(), 3, mesh.feature_of(v));
                }
                double last = objective(mesh, feature, terms);
                for (int n = 0; n < 4; ++n) {
                    fit_colors(mesh, feature, terms);
                    const double now = objective(mesh, feature, terms);
                    CHECK(now <= last * (1 + 1e-5) + 1e-6);
                    last = now;
                }
                for (Id v = 0; v < mesh.vertex_count(); ++v)
                    CHECK(in_gamut(Vec3f(mesh.feature_of(v))) == Vec3f(mesh.feature_of(v)));
            }
        }
    }
}

TEST_CASE("fit map: a constant image is reproduced by any mesh") {
    for (const Vec3f& encoded : {Vec3f(0.2f, 0.5f, 0.7f), Vec3f(1, 1, 1), Vec3f(0, 0, 0), Vec3f(0, 0, 1)}) {
        Image image = make_image(30, 20, 3);
        for (std::size_t i = 0; i < image.data.size(); ++i)
            image.data[i] = encoded[static_cast<Eigen::Index>(i % 3)];
        const FeatureImage feature = luv_image(image);
        for (const bool jittered : {true, false}) {
            BaseMesh mesh = jittered ? jittered_grid(0, 0, 29, 19, 4, 3, 9) : collapsed(feature, 12);
            for (Id v = 0; v < mesh.vertex_count(); ++v)
                std::copy_n(feature.data.data(), 3, mesh.feature_of(v));
            const PixelMap map = fit_map(mesh, feature, {});
            // Only the rounding to 16-bit codes is lost.
            const Vec3f color(feature.data.data());
            CHECK(map_rms(mesh, map, feature) <= double((quantized_color(color) - color).norm()) + 2e-4);
        }
    }
}

TEST_CASE("fit map: every colour is one that a container holds") {
    for (const Kind kind : kAllKinds) {
        const FeatureImage feature = sample_feature(kind, 24, 18);
        BaseMesh mesh = collapsed(feature, 30);
        fit_map(mesh, feature, {});
        for (Id v = 0; v < mesh.vertex_count(); ++v) {
            const Vec3f luv(mesh.feature_of(v));
            CHECK(quantized_color(luv) == luv);
        }
    }
}

TEST_CASE("fit map: the map that may move is better than the trivial one") {
    for (const Kind kind : {Kind::kDisc, Kind::kNoise, Kind::kGradient, Kind::kCheckerboard}) {
        INFO(name_of(kind));
        const FeatureImage feature = sample_feature(kind, 40, 30);
        BaseMesh moving = collapsed(feature, 40), trivial = moving;
        FitParams rest;
        rest.color_weight = 0;
        const PixelMap map = fit_map(moving, feature, {}), still = fit_map(trivial, feature, rest);
        CHECK(map_rms(moving, map, feature) < map_rms(trivial, still, feature));
        CHECK(map_quality(moving, map).flipped_triangles == 0);
    }
}

TEST_CASE("fit map: weights as coarse as asked for, or an error that says what helps") {
    const FeatureImage feature = sample_feature(Kind::kDisc, 24, 18);
    for (const WeightPrecision wanted : {WeightPrecision::kHalf, WeightPrecision::kFloat}) {
        BaseMesh mesh = collapsed(feature, 30);
        FitParams params;
        params.bary = wanted;
        CHECK(fit_map(mesh, feature, params).precision == wanted);
    }
    BaseMesh wide;
    wide.position = {{0, 0}, {0, 3}, {2600, 3}, {2600, 0}};
    wide.feature.assign(12, 0.0f);
    wide.faces = {{0, 1, 2}, {0, 2, 3}};
    const FeatureImage flat = sample_feature(Kind::kConstant, 2601, 4);
    FitParams half;
    half.bary = WeightPrecision::kHalf;
    CHECK_THROWS_WITH_AS(fit_map(wide, flat, half), doctest::Contains("float"), Error);
    CHECK(fit_map(wide, flat, {}).precision == WeightPrecision::kFloat);
}

TEST_CASE("trivial map: without colour weight every pixel stays at its centre, as far as the weights reach") {
    for (const auto& [w, h] : {std::pair{40, 30}, {1, 12}, {12, 1}, {1, 1}, {2, 2}}) {
        INFO(w << " x " << h);
        const FeatureImage feature = sample_feature(Kind::kNoise, w, h);
        BaseMesh mesh = collapsed(feature, w * h > 100 ? 60 : 4);
        FitParams params;
        params.color_weight = 0;
        params.bary = WeightPrecision::kFloat;
        const PixelMap map = fit_map(mesh, feature, params);
        const std::vector<Vec2d> positions = mapped_positions(mesh, map);
        for (int y = 0; y < h; ++y)
            for (int x = 0; x < w; ++x)
                CHECK((positions[static_cast<std::size_t>(y * w + x)] - Vec2d(x, y)).norm() <
                      50 * double(kFloatWeightStep));
    }
}

// The sums are taken in floats, run by run. Here they are taken pixel by pixel in doubles.
TEST_CASE("colour sums: of a map, and of pixels that are being moved") {
    const FeatureImage feature = sample_feature(Kind::kNoise, 70, 45);
    const BaseMesh mesh = collapsed(feature, 60);
    PixelMap map = trivial_map(mesh, 70, 45);
    for (std::size_t i = 0; i < map.size(); i += 7) map[i] = {};  // as outside a mask
    const ColorSums sums = color_sums(feature, map, mesh.faces.size()),
                    moved = color_sums(feature, resting_pixels(map), face_fields(mesh));
    std::vector<double> clear(sums.values.size());
    for (std::size_t i = 0; i < map.size(); ++i) {
        if (map[i].face == kNone) continue;
        const double u = double{map[i].u}, v = double{map[i].v};
        const std::array<double, 3> w = {1 - u - v, u, v};
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t k = 0; k < 6; ++k)
                clear[(map[i].face * 3 + a) * 6 + k] +=
                    w[a] * (k < 3 ? w[k] : double{feature.pixel(i)[k - 3]});
    }
    for (std::size_t n = 0; n < clear.size(); ++n) {
        CHECK(sums.values[n] == doctest::Approx(clear[n]).epsilon(1e-6).scale(100));
        CHECK(moved.values[n] == doctest::Approx(clear[n]).epsilon(1e-4).scale(100));
    }
}
