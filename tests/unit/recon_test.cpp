#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/image/luv_encoder.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/recon/draw.h"
#include "libcore/recon/patch_colors.h"
#include "libcore/recon/visit_lightness.h"
#include "tests/support/grid_mesh_image.h"
#include "tests/support/meshes.h"

using namespace imgmesh;
using doctest::Approx;
using imgmesh::test::grid_mesh_image;

namespace {

constexpr ColorSpace kSpaces[] = {ColorSpace::kSrgb,    ColorSpace::kLinear,   ColorSpace::kRec709,
                                  ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3};

Vec3f corner(const BaseMesh& mesh, Id v) {
    return Eigen::Map<const Vec3f>(mesh.feature_of(v));
}

Vec3f rgb(const Image& image, int x, int y) {
    return Eigen::Map<const Vec3f>(image.pixel(x, y));
}

void set_all(BaseMesh& mesh, const Vec3f& luv) {
    for (Id v = 0; v < mesh.vertex_count(); ++v) std::copy(luv.data(), luv.data() + 3, mesh.feature_of(v));
}

}  // namespace

TEST_CASE("LuvEncoder: as the plain form, in and out of gamut, for every space and odd lengths") {
    std::mt19937 random(3);
    const auto uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    std::vector<Vec3f> colors = {{0, 0, 0},    {100, 0, 0},       {8, 0, 0},     {8, 3, -4},
                                 {0, 30, 20},  {-5, 10, 0},       {1e-7f, 0, 0}, {1e-20f, 0, 0},
                                 {5, 0, -100}, {50, -200, 0},     {110, 0, 0},   {60, 200, -300},
                                 {1, 0.5f, 1}, {99.999f, 0.1f, 0}};
    for (int i = 0; i < 20000; ++i) {
        const float scale = std::pow(10.0f, uniform(-5, 0));
        colors.push_back(
            luv_from_linear({scale * uniform(0, 1), scale * uniform(0, 1), scale * uniform(0, 1)}));
    }
    for (int i = 0; i < 5000; ++i)
        colors.push_back({uniform(0, 100), uniform(-150, 150), uniform(-150, 150)});
    const int n = static_cast<int>(colors.size());
    REQUIRE(n % 64 != 0);
    std::vector<float> planes(colors.size() * 3);
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) planes[c * colors.size() + i] = colors[i][int(c)];
    for (const ColorSpace space : kSpaces) {
        INFO(color_space_name(space));
        std::vector<float> out(colors.size() * 4, -9.0f);
        LuvEncoder(space).encode_row(planes, n, out.data(), 4);
        double worst = 0;
        for (std::size_t i = 0; i < colors.size(); ++i) {
            const Vec3f want = encoded_from_luv(space, colors[i]),
                        got(out[4 * i], out[4 * i + 1], out[4 * i + 2]);
            // Far outside the gamut linear results have no bound, and float cancels where v' is nearly 0.
            const float size = want.cwiseAbs().maxCoeff();
            worst =
                std::max(worst, double((got - want).cwiseAbs().maxCoeff() / (size > 1 ? 10 * size : 1.0f)));
            REQUIRE(out[4 * i + 3] == -9.0f);
        }
        // Rec709's curve jumps by 2.5e-4 where its branches meet, since the standard rounds its constants.
        CHECK(worst < (space == ColorSpace::kRec709 ? 2e-4 : 2.0 / 65535));
    }
}

// With every pixel as a vertex the reconstruction must be exact.
TEST_CASE("draw map: a mesh of all pixels gives the image back") {
    MeshImage m = grid_mesh_image(17, 11, 16, 10, 1);
    BaseMesh& mesh = m.levels[0].mesh;
    for (Vec2f& p : mesh.position) p = {std::round(p.x()), std::round(p.y())};
    m.levels[0].map = trivial_map(mesh, 17, 11);
    const Image image = draw(m, 0, {});
    CHECK(image.channels == 3);
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        const Vec3f want = encoded_from_luv(ColorSpace::kSrgb, corner(mesh, v));
        const Vec2f& p = mesh.position[v];
        CHECK((rgb(image, int(p.x()), int(p.y())) - want).cwiseAbs().maxCoeff() < 2.0 / 65535);
    }
}

TEST_CASE("draw: a constant mesh is a constant image in every colour space") {
    MeshImage m = grid_mesh_image(40, 30, 5, 4, 2);
    const Vec3f luv = luv_from_linear({0.2f, 0.5f, 0.1f});
    set_all(m.levels[0].mesh, luv);
    for (const ColorSpace space : kSpaces) {
        m.source.color_space = space;
        const Vec3f want = encoded_from_luv(space, luv);
        for (const DrawMode mode : {DrawMode::kMap, DrawMode::kGouraud, DrawMode::kFlat}) {
            const Image image = draw(m, 0, {.mode = mode});
            CHECK(image.color_space == space);
            double worst = 0;
            for (int y = 0; y < 30; ++y)
                for (int x = 0; x < 40; ++x)
                    worst = std::max(worst, double((rgb(image, x, y) - want).cwiseAbs().maxCoeff()));
            CHECK(worst < 3e-5);
        }
    }
}

// The map, not the mesh alone, decides: pixels moved to other places of the mesh take their colours.
TEST_CASE("draw map: every pixel interpolates its face's corners with its own weights") {
    MeshImage m = grid_mesh_image(40, 30, 5, 4, 3);
    std::mt19937 random(4);
    Level& level = m.levels[0];
    for (PixelCoord& c : level.map) {
        const float u = float(random() % 1025) / 1024, v = (1 - u) * float(random() % 1025) / 1024;
        c = {static_cast<Id>(random() % level.mesh.faces.size()), u, v};
    }
    const Image image = draw(m, 0, {});
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const PixelCoord& c = level.map.row(y)[std::size_t(x)];
            const Face& f = level.mesh.faces[c.face];
            const Vec3f luv = (1 - c.u - c.v) * corner(level.mesh, f[0]) + c.u * corner(level.mesh, f[1]) +
                              c.v * corner(level.mesh, f[2]);
            const Vec3f want = encoded_from_luv(ColorSpace::kSrgb, luv);
            CHECK((rgb(image, x, y) - want).cwiseAbs().maxCoeff() < 2.0 / 65535);
        }
}

// L* linear in x must come out as L* at the sample's place, also at the clamped borders.
TEST_CASE("draw gouraud: an enlarged image samples at (i + 0.5) / scale - 0.5") {
    MeshImage m = grid_mesh_image(21, 9, 4, 2, 5);
    for (Id v = 0; v < m.levels[0].mesh.vertex_count(); ++v)
        for (int c = 0; c < 3; ++c)
            m.levels[0].mesh.feature_of(v)[c] = c == 0 ? 10 + 4 * m.levels[0].mesh.position[v].x() : 0.0f;
    for (const double scale : {1.0, 2.0, 0.5, 3.3}) {
        const Image image = draw(m, 0, {DrawMode::kGouraud, scale});
        CHECK(image.width == std::lround(scale * 21));
        CHECK(image.height == std::lround(scale * 9));
        for (int x = 0; x < image.width; ++x) {
            const double at = std::clamp((x + 0.5) / scale - 0.5, 0.0, 20.0);
            const float want = encoded_from_luv(ColorSpace::kSrgb, {float(10 + 4 * at), 0, 0})[0];
            for (int y = 0; y < image.height; ++y) CHECK(image.pixel(x, y)[0] == Approx(want).epsilon(1e-4));
        }
    }
}

// One square of two triangles, light grey: its diagonal and sides are dark, its inside is lighter than
// before.
TEST_CASE("draw wire: dark lines on the edges, one output pixel wide, the rest lightened") {
    MeshImage m;
    m.source.width = m.source.height = 41;
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    mesh.position = {{0, 0}, {0, 40}, {40, 40}, {40, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    mesh.feature.assign(12, 0.0f);
    set_all(mesh, {60, 0, 0});
    const Image image = draw(m, 0, {.mode = DrawMode::kWire});
    const float before = encoded_from_luv(ColorSpace::kSrgb, {60, 0, 0})[1];
    const auto g = [&](int x, int y) { return image.pixel(x, y)[1]; };
    CHECK(g(20, 20) < 0.4f * before);
    CHECK(g(20, 0) < 0.4f * before);
    CHECK(g(0, 20) < 0.4f * before);
    CHECK(g(40, 20) < 0.4f * before);
    CHECK(g(10, 30) > 1.1f * before);
    CHECK(g(22, 20) == Approx(g(10, 30)));  // 1.4 pixels from the diagonal
    CHECK(g(21, 20) > g(20, 20));           // antialiased: 0.7 pixels
    CHECK(g(21, 20) < g(22, 20));
}

TEST_CASE("draw patches: touching patches differ clearly, borders are darker") {
    for (std::uint32_t seed = 1; seed <= 5; ++seed) {
        MeshImage m = grid_mesh_image(80, 60, 8, 6, seed);
        set_all(m.levels[0].mesh, {60, 0, 0});  // the worst case: one colour everywhere
        const PixelMap& map = m.levels[0].map;
        const std::vector<Vec3f> colors = patch_colors(m.levels[0].mesh, map);
        double least = 1e9;
        for (int y = 0; y < 60; ++y)
            for (std::size_t x = 0; x + 1 < 80; ++x) {
                const Id a = map.row(y)[x].face, b = map.row(y)[x + 1].face;
                if (a != b) least = std::min(least, double((colors[a] - colors[b]).norm()));
            }
        CHECK(least > 20);
        const Image image = draw(m, 0, {.mode = DrawMode::kPatches});
        for (int y = 0; y < 59; ++y)
            for (std::size_t x = 0; x < 79; ++x) {
                const Id face = map.row(y)[x].face;
                const bool border = map.row(y)[x + 1].face != face || map.row(y + 1)[x].face != face;
                const Vec3f luv = (border ? 0.6f : 1.0f) * colors[face];
                CHECK((rgb(image, int(x), y) - encoded_from_luv(ColorSpace::kSrgb, luv)).norm() < 1e-3);
            }
    }
}

TEST_CASE("draw: a mask gives alpha, 0 outside with black") {
    MeshImage m = grid_mesh_image(20, 20, 3, 3, 7);
    m.source.has_mask = true;
    m.levels[0].map.row(4)[5] = {};
    const Image image = draw(m, 0, {});
    CHECK(image.channel_names == std::vector<std::string>{"R", "G", "B", "A"});
    CHECK(rgb(image, 5, 4).norm() == 0);
    CHECK(image.pixel(5, 4)[3] == 0);
    CHECK(image.pixel(6, 4)[3] == 1);
    CHECK(draw(m, 0, {.mode = DrawMode::kPatches}).pixel(5, 4)[3] == 0);
    m.levels[0].mesh.faces.pop_back();
    const Image gouraud = draw(m, 0, {.mode = DrawMode::kGouraud});
    int outside = 0;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) outside += gouraud.pixel(x, y)[3] == 0;
    CHECK(outside > 0);
    CHECK(outside < 100);
}

TEST_CASE("draw: the same bytes for one thread and several") {
    const MeshImage m = grid_mesh_image(100, 80, 9, 7, 8);
    for (const DrawMode mode : {DrawMode::kMap, DrawMode::kGouraud, DrawMode::kPatches}) {
        const Image many = draw(m, 0, {.mode = mode});
        const ThreadLimit limit(1);
        CHECK(draw(m, 0, {.mode = mode}).data == many.data);
    }
}

TEST_CASE("draw: levels and scales that are not there") {
    MeshImage m = grid_mesh_image(10, 10, 2, 2, 9);
    CHECK_THROWS_WITH_AS(draw(m, 1, {}), "level is 1, expected 0 to 0", Error);
    CHECK_THROWS_AS(draw(m, -1, {}), Error);
    CHECK_THROWS_AS(draw(m, 0, {DrawMode::kMap, 2}), Error);
    CHECK_THROWS_AS(draw(m, 0, {DrawMode::kPatches, 2}), Error);
    for (const double scale : {0.0, -1.0, 1e9, std::numeric_limits<double>::quiet_NaN()})
        CHECK_THROWS_AS(draw(m, 0, {DrawMode::kWire, scale}), Error);
    CHECK(draw(m, 0, {DrawMode::kFlat, 0.01}).width == 1);
    CHECK_THROWS_AS(draw_svg(m, 0, DrawMode::kMap), Error);
    CHECK_THROWS_AS(draw_svg(m, 3, DrawMode::kFlat), Error);
    m.levels[0].mesh.channels = 1;
    CHECK_THROWS_AS(draw(m, 0, {}), Error);
}

// Of 100 pixels with 1, 2, ... 100 visits the two ends are cut off; the rest goes evenly from white to black.
TEST_CASE("draw: faces all over one another are refused before work") {
    MeshImage m = grid_mesh_image(40, 30, 4, 3, 5);
    BaseMesh& mesh = m.levels[0].mesh;
    const std::vector<std::array<Id, 3>> once = mesh.faces;
    const auto refused = [&](DrawMode mode, double scale) {
        try {
            draw(m, 0, {mode, scale});
        } catch (const Error& error) {
            CHECK(error.kind() == ErrorKind::kUnsupported);
            return true;
        }
        return false;
    };
    for (int n = 0; n < 20; ++n) mesh.faces.insert(mesh.faces.end(), once.begin(), once.end());
    CHECK_FALSE(refused(DrawMode::kGouraud, 8));
    for (int n = 0; n < 3000; ++n) mesh.faces.insert(mesh.faces.end(), once.begin(), once.end());
    for (const DrawMode mode : {DrawMode::kGouraud, DrawMode::kWire, DrawMode::kFlat})
        for (const double scale : {1.0, 8.0}) CHECK(refused(mode, scale));
    // Slivers have no area, but each row of each costs time.
    mesh.faces.assign(200'000, {0, as_id(mesh.vertex_count() - 1), 0});
    CHECK(refused(DrawMode::kFlat, 8));
}

TEST_CASE("draw: visits, the less the brighter") {
    MeshImage m = grid_mesh_image(10, 10, 2, 2, 9);
    CHECK_THROWS_AS(draw(m, 0, {DrawMode::kVisits}), Error);
    for (Id v = 1; v <= 100; ++v) m.visits.push_back(v);
    const std::vector<float> lightness = visit_lightness(m);
    CHECK(lightness[0] == 100);
    CHECK(lightness[1] == 100);
    CHECK(lightness[2] < 100);
    CHECK(lightness[49] == Approx(100.0 * 48 / 96));
    CHECK(lightness[97] == 0);
    CHECK(lightness[99] == 0);
    const Image image = draw(m, 0, {DrawMode::kVisits});
    for (int x = 0; x < 10; ++x)
        for (int c = 0; c < 3; ++c) {
            CHECK(image.pixel(x, 4)[c] == Approx(image.pixel(x, 4)[0]).epsilon(1e-3));  // grey
            if (x > 0) CHECK(image.pixel(x, 4)[c] < image.pixel(x - 1, 4)[c]);
        }
    m.levels[0].map[0] = {};  // outside the mask
    CHECK(visit_lightness(m)[0] == 0);
    std::fill(m.visits.begin(), m.visits.end(), 7);
    CHECK(visit_lightness(m)[5] == 100);
    m.levels.push_back(m.levels[0]);
    CHECK_THROWS_AS(draw(m, 1, {DrawMode::kVisits}), Error);
    CHECK_THROWS_AS(draw(m, 0, {DrawMode::kVisits, 2}), Error);
}

TEST_CASE("draw_svg: two triangles, written out") {
    MeshImage m;
    m.source.width = 9;
    m.source.height = 5;
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    mesh.position = {{0, 0}, {0, 4}, {8, 4}, {3.5f, 1.03125f}};
    mesh.faces = {{0, 1, 3}, {1, 2, 3}};
    mesh.feature.assign(12, 0.0f);
    set_all(mesh, {100, 0, 0});
    CHECK(draw_svg(m, 0, DrawMode::kFlat) ==
          "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"5\" viewBox=\"-.5 -.5 9 5\">\n"
          "<g stroke-width=\".7\" stroke-linejoin=\"round\">\n"
          "<path fill=\"#ffffff\" stroke=\"#ffffff\" d=\"M-.5 -.5L-.5 4.5L3.5 1.03z\"/>\n"
          "<path fill=\"#ffffff\" stroke=\"#ffffff\" d=\"M-.5 4.5L8.5 4.5L3.5 1.03z\"/>\n"
          "</g>\n</svg>\n");
    CHECK(
        draw_svg(m, 0, DrawMode::kWire) ==
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"5\" viewBox=\"-.5 -.5 9 5\">\n"
        "<path fill=\"none\" stroke=\"#12263a\" stroke-width=\".6\" stroke-linecap=\"round\" d=\"\n"
        "M-.5 -.5L-.5 4.5M-.5 -.5L3.5 1.03M-.5 4.5L8.5 4.5M-.5 4.5L3.5 1.03M8.5 4.5L3.5 1.03\"/>\n</svg>\n");
}

// Colours that change along x alone are a linear gradient along x, from corner to corner.
TEST_CASE("draw_svg_gradient: black on the left, white on the right") {
    MeshImage m;
    m.source.width = 9;
    m.source.height = 5;
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    mesh.position = {{0, 0}, {0, 4}, {8, 4}};
    mesh.faces = {{0, 1, 2}};
    mesh.feature = {0, 0, 0, 0, 0, 0, 100, 0, 0};
    const std::string svg = draw_svg_gradient(m, 0);
    INFO(svg);
    CHECK(svg.find(" x1=\"-.5\" y1=\"2.83\" x2=\"8.5\" y2=\"2.83\"><stop stop-color=\"#000000\"/>"
                   "<stop offset=\"1\" stop-color=\"#ffffff\"/>") != std::string::npos);
}

// A face fades along its gradient, without a stroke; one that is not seen at all is left out.
TEST_CASE("draw_svg_gradient: alpha is opacity") {
    MeshImage m;
    m.source.width = 9;
    m.source.height = 5;
    m.source.channel_names = {"R", "G", "B", "A"};
    m.levels.resize(1);
    BaseMesh& mesh = m.levels[0].mesh;
    mesh.channels = 4;
    mesh.position = {{0, 0}, {0, 4}, {8, 4}, {8, 0}};
    mesh.faces = {{0, 1, 2}, {0, 2, 3}};
    mesh.feature = {100, 0, 0, 0, 100, 0, 0, 0, 100, 0, 0, 1, 100, 0, 0, 1};
    const std::string svg = draw_svg_gradient(m, 0);
    INFO(svg);
    CHECK(
        svg.find(
            "x1=\"-.5\" y1=\"2.83\" x2=\"8.5\" y2=\"2.83\"><stop stop-color=\"#ffffff\" stop-opacity=\"0\"/>"
            "<stop offset=\"1\" stop-color=\"#ffffff\"/>") != std::string::npos);
    CHECK(svg.find("stroke=\"") == std::string::npos);
    for (Id v = 0; v < 3; ++v) mesh.feature_of(v)[3] = 0;
    CHECK(draw_svg_gradient(m, 0).find("g0") == std::string::npos);
}
