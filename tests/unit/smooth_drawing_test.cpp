// The antialiased drawings against slow ones that take hundreds of samples a pixel.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/recon/coverage.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/level_colors.h"
#include "libcore/recon/svg_places.h"
#include "tests/support/grid_mesh_image.h"
#include "tests/support/meshes.h"

using namespace imgmesh;
using doctest::Approx;
using imgmesh::test::grid_mesh_image;

namespace {

double cross(const Vec2d& a, const Vec2d& b) {
    return a.y() * b.x() - a.x() * b.y();
}

// The face with the lowest id that covers a point, or kNone.
Id face_at(const BaseMesh& mesh, const std::vector<Vec2d>& points, const Vec2d& p) {
    for (Id f = 0; f < mesh.faces.size(); ++f) {
        const auto [a, b, c] = mesh.faces[f];
        if (cross(points[b] - points[a], points[c] - points[a]) > 0 &&
            cross(points[b] - p, points[c] - p) >= 0 && cross(points[c] - p, points[a] - p) >= 0 &&
            cross(points[a] - p, points[b] - p) >= 0)
            return f;
    }
    return kNone;
}

// The flat drawing from n x n samples in each pixel: L*u*v* and, in the fourth place, the covered part.
std::vector<std::array<float, 4>> sampled_flat(const MeshImage& m, double scale, int width, int height) {
    constexpr int n = 16;
    const BaseMesh& mesh = m.levels[0].mesh;
    const std::vector<Vec2d> points = outward(m.levels[0], m.source);
    const std::vector<Vec3f> colors = face_means(mesh);
    std::vector<std::array<float, 4>> out;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Vec3f sum(0, 0, 0);
            int inside = 0;
            for (int k = 0; k < n * n; ++k) {
                const Vec2d at =
                    Vec2d(x + (k % n + 0.5) / n, y + (k / n + 0.5) / n) / scale - Vec2d(0.5, 0.5);
                const Id face = face_at(mesh, points, at);
                if (face == kNone) continue;
                sum += colors[face];
                ++inside;
            }
            sum /= static_cast<float>(std::max(inside, 1));
            out.push_back({sum[0], sum[1], sum[2], static_cast<float>(inside) / (n * n)});
        }
    return out;
}

}  // namespace

// The parts of a triangle add up to its area, each pixel's is right, and their centroids to its centroid.
TEST_CASE("coverage: the parts of a triangle in all pixels are the triangle") {
    const std::array<std::array<Vec2d, 3>, 5> triangles = {{
        {Vec2d(0.2, 0.1), Vec2d(1.7, 5.9), Vec2d(6.8, 3.3)},
        {Vec2d(1, 1), Vec2d(1, 5), Vec2d(5, 1)},
        {Vec2d(0.5, 2.25), Vec2d(7.5, 2.5), Vec2d(7.25, 2.25)},  // in one row
        {Vec2d(3.5, 0), Vec2d(3.25, 7), Vec2d(3.75, 7)},         // in one column
        {Vec2d(4.25, 4.25), Vec2d(4.5, 4.75), Vec2d(4.75, 4.5)}  // in one pixel
    }};
    for (const auto& t : triangles) {
        double sum = 0;
        Vec2d moment(0, 0);
        for (const auto& [begin, end] : {std::pair(0, 3), std::pair(3, 8)}) {  // two bands
            const int first = begin, last = end;
            for_each_covered(t, first, last, 8, [&](int x, int y, double area, const Vec2d& centroid) {
                CHECK(y >= first);
                CHECK(y < last);
                CHECK(area > 0);
                CHECK(area <= 1);
                CHECK(std::abs(centroid.x() - x - 0.5) <= 0.5);
                CHECK(std::abs(centroid.y() - y - 0.5) <= 0.5);
                sum += area;
                moment += area * centroid;
            });
        }
        const double area = std::abs(cross(t[1] - t[0], t[2] - t[0])) / 2;
        CHECK(sum == Approx(area).epsilon(1e-12));
        CHECK((moment / sum - (t[0] + t[1] + t[2]) / 3).norm() < 1e-12);
    }
}

// What lies outside is left out, without a change of the rest.
TEST_CASE("coverage: a triangle that reaches beyond the drawing") {
    double sum = 0;
    for_each_covered({Vec2d(-4, -4), Vec2d(-4, 12), Vec2d(12, -4)}, 0, 3, 2,
                     [&](int x, int y, double area, const Vec2d&) {
                         CHECK(x >= 0);
                         CHECK(x < 2);
                         CHECK(y < 3);
                         CHECK(area == 1);
                         sum += area;
                     });
    CHECK(sum == 6);
}

TEST_CASE("draw flat: each pixel is the mean of what covers it, at any scale") {
    MeshImage m = grid_mesh_image(23, 17, 3, 2, 6);
    for (const bool masked : {false, true})
        for (const double scale : {1.0, 4.0, 0.5, 1.7, 0.1}) {
            INFO("scale " << scale << " masked " << masked);
            m.source.has_mask = masked;
            const Image image = draw(m, 0, {DrawMode::kFlat, scale});
            const auto samples = sampled_flat(m, scale, image.width, image.height);
            double worst = 0, total = 0;
            for (int y = 0; y < image.height; ++y)
                for (int x = 0; x < image.width; ++x) {
                    const auto& s = samples[std::size_t(y * image.width + x)];
                    const Vec3f want = encoded_from_luv(ColorSpace::kSrgb, {s[0], s[1], s[2]});
                    const float* got = image.pixel(x, y);
                    const double error = (Eigen::Map<const Vec3f>(got) - want).cwiseAbs().maxCoeff();
                    worst = std::max(worst, error);
                    total += error;
                    if (masked && x < image.width - 1 && y < image.height - 1)
                        CHECK(got[3] == Approx(s[3]).epsilon(0.02));
                }
            // 16 samples a side see the place of a border to 1/32 pixel.
            CHECK(worst < 0.05);
            CHECK(total / double(image.width * image.height) < 0.004);
        }
}

// The background must not shine through where faces meet: faces of one colour are one area of this colour.
TEST_CASE("draw flat and wire: no hairlines, and no clear pixels inside") {
    MeshImage m = grid_mesh_image(60, 45, 9, 7, 3);
    BaseMesh& mesh = m.levels[0].mesh;
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        for (int c = 0; c < 3; ++c) mesh.feature_of(v)[c] = c == 0 ? 70.0f : 5.0f;
    m.source.has_mask = true;
    const Vec3f color = encoded_from_luv(ColorSpace::kSrgb, {70, 5, 5});
    for (const double scale : {1.0, 3.7, 0.4}) {
        const Image flat = draw(m, 0, {DrawMode::kFlat, scale}), wire = draw(m, 0, {DrawMode::kWire, scale});
        for (int y = 0; y + 1 < flat.height; ++y)
            for (int x = 0; x + 1 < flat.width; ++x) {
                CHECK((Eigen::Map<const Vec3f>(flat.pixel(x, y)) - color).cwiseAbs().maxCoeff() < 1e-4);
                CHECK(flat.pixel(x, y)[3] == 1);
                CHECK(wire.pixel(x, y)[3] == 1);
            }
    }
}

// A line across the middle: its profile is the same in every column, however steep it is, and its width that
// of sqrt(scale) pixels.
TEST_CASE("draw wire: lines have one width") {
    MeshImage m;
    m.source.width = m.source.height = 41;
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    mesh.position = {{0, 0}, {0, 40}, {40, 40}, {40, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    mesh.feature.assign(12, 0.0f);
    for (Id v = 0; v < 4; ++v) mesh.feature_of(v)[0] = 100;
    for (const double scale : {1.0, 4.0, 9.0}) {
        const Image image = draw(m, 0, {DrawMode::kWire, scale});
        const int half = image.width / 2, reach = static_cast<int>(4 * std::sqrt(scale));
        const float white = image.pixel(half + reach, half)[1], black = image.pixel(half, half)[1];
        for (int y = half - 9; y < half + 9; ++y) {
            double ink = 0;  // along the row, which crosses the diagonal
            for (int x = y - reach; x <= y + reach; ++x)
                ink += (white - image.pixel(x, y)[1]) / (white - black);
            // Encoded steps are not those of L*, so the ramp of a pixel is not straight.
            CHECK(ink == Approx(std::sqrt(2 * scale)).epsilon(0.12));
        }
    }
}

TEST_CASE("draw flat and wire: the same bytes for one thread and several") {
    const MeshImage m = grid_mesh_image(100, 80, 9, 7, 8);
    for (const DrawMode mode : {DrawMode::kFlat, DrawMode::kWire})
        for (const double scale : {1.0, 2.3}) {
            const Image many = draw(m, 0, {mode, scale});
            const ThreadLimit limit(1);
            CHECK(draw(m, 0, {mode, scale}).data == many.data);
        }
}

TEST_CASE("draw flat and wire: images of one pixel and of one row") {
    for (const auto& [width, height] : {std::pair(1, 1), std::pair(1, 7), std::pair(7, 1), std::pair(2, 2)})
        for (const double scale : {1.0, 5.0, 0.3}) {
            MeshImage m;
            m.source.width = width;
            m.source.height = height;
            m.levels.resize(1);
            BaseMesh& mesh = m.levels[0].mesh;
            const float left = width == 1 ? -0.5f : 0, top = height == 1 ? -0.5f : 0,
                        right = width == 1 ? 0.5f : float(width - 1),
                        bottom = height == 1 ? 0.5f : float(height - 1);
            mesh.position = {{left, top}, {left, bottom}, {right, bottom}, {right, top}};
            mesh.faces = {{0, 1, 2}, {0, 2, 3}};
            mesh.feature.assign(12, 0.0f);
            for (Id v = 0; v < 4; ++v) mesh.feature_of(v)[0] = 50;
            const Image image = draw(m, 0, {DrawMode::kFlat, scale});
            CHECK(image.width == std::max(1L, std::lround(scale * width)));
            CHECK(image.height == std::max(1L, std::lround(scale * height)));
            const float grey = encoded_from_luv(ColorSpace::kSrgb, {50, 0, 0})[0];
            for (const float value : image.data) CHECK(value == Approx(grey).epsilon(1e-4));
            CHECK(draw(m, 0, {DrawMode::kWire, scale}).width == image.width);
        }
}
