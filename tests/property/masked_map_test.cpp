// What must hold for the pixel map of any masked image.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/param/relax.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_masks.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

struct Scene {
    FeatureImage feature;
    Mask mask;
    BaseMesh mesh;
    std::vector<FaceField> fields;
    std::vector<Face> neighbors;
    PixelEmbedding pixels;
};

Scene scene(Kind kind, const Mask& mask, std::int64_t vertices) {
    Scene s;
    s.feature = sample_feature(kind, mask.width, mask.height);
    s.mask = mask;
    s.mesh = simplify(grid_mesh(s.feature, mask), plain_params(), SimplifyTarget{.vertices = vertices}).mesh;
    s.fields = face_fields(s.mesh);
    s.neighbors = face_neighbors(s.mesh);
    s.pixels = resting_pixels(trivial_map(s.mesh, mask.width, mask.height, mask), mask);
    return s;
}

double area2(const Vec2f& p, const Vec2f& q, const Vec2f& r) {
    const Vec2d a = (q - p).cast<double>(), b = (r - p).cast<double>();
    return a.x() * b.y() - a.y() * b.x();
}

// The least twice-area over all triples of pixels inside of one cell, in the grid's orientation.
double least_area2(const Scene& s) {
    double least = 1;
    for (int y = 0; y + 1 < s.mask.height; ++y)
        for (int x = 0; x + 1 < s.mask.width; ++x)
            for (int out = 0; out < 4; ++out) {
                constexpr int kX[4] = {0, 1, 1, 0}, kY[4] = {0, 0, 1, 1};
                Vec2f corner[3];
                int n = 0;
                for (int k = 1; k < 4; ++k) {
                    const int c = (out + k) % 4, px = x + kX[c], py = y + kY[c];
                    if (s.mask.at(px, py)) corner[n++] = s.pixels.image_of(px, py);
                }
                if (n < 3) continue;
                const double area = area2(corner[0], corner[1], corner[2]);
                if (std::isnan(area)) return area;
                least = std::min(least, area);
            }
    return least;
}

// A pixel is free if its four neighbours are inside and no two diagonal ones between two of them are outside.
// On a straight side of the mask it may slide; otherwise it rests. Found from rows of the mask, not from
// fans.
bool straight_side(const Mask& m, int x, int y, int dx, int dy) {
    const auto side = [&](int s) {  // all three pixels on one side
        const int sx = dy * s, sy = dx * s;
        return m.at(x + sx, y + sy) + m.at(x + sx + dx, y + sy + dy) + m.at(x + sx - dx, y + sy - dy);
    };
    if (!m.at(x + dx, y + dy) || !m.at(x - dx, y - dy)) return false;
    // Triangles fill one side, and the other has none: the pixel across is outside, and no cell there has
    // three.
    const auto full = [&](int s) { return side(s) >= 1 && m.at(x + dy * s, y + dx * s); };
    const auto bare = [&](int s) { return side(s) == 0; };
    return (full(1) && bare(-1)) || (full(-1) && bare(1));
}

void check_boundary(const Scene& s) {
    for (int y = 0; y < s.mask.height; ++y)
        for (int x = 0; x < s.mask.width; ++x) {
            if (!s.mask.at(x, y)) continue;
            int around = 0;
            for (int k = 0; k < 9; ++k) around += s.mask.at(x + k % 3 - 1, y + k / 3 - 1);
            const bool deep = around == 9;
            const Vec2f p = s.pixels.image_of(x, y);
            const bool moved_x = p.x() != static_cast<float>(x), moved_y = p.y() != static_cast<float>(y);
            int straight_neighbors = 0;
            for (const int k : {1, 3, 5, 7}) straight_neighbors += s.mask.at(x + k % 3 - 1, y + k / 3 - 1);
            if (deep || straight_neighbors == 4) continue;  // inside
            if (moved_x && moved_y) FAIL_CHECK("pixel (" << x << ", " << y << ") left the boundary");
            if (moved_x) CHECK(straight_side(s.mask, x, y, 1, 0));
            if (moved_y) CHECK(straight_side(s.mask, x, y, 0, 1));
        }
}

void check_faces(const Scene& s) {
    for (int y = 0; y < s.mask.height; ++y)
        for (int x = 0; x < s.mask.width; ++x) {
            const std::size_t i = s.pixels.index(x, y);
            if (!s.mask.contains(i)) {
                CHECK(s.pixels.face[i] == kNone);
                continue;
            }
            REQUIRE(s.pixels.face[i] < s.fields.size());
            const FaceField& field = s.fields[s.pixels.face[i]];
            const Vec2f p = s.pixels.image_of(x, y);
            const float u = field.u(p.x(), p.y()), v = field.v(p.x(), p.y());
            CHECK(std::min({u, v, 1 - u - v}) >= -2e-4f);
        }
}

double total_displacement(const PixelEmbedding& pixels) {
    double sum = 0;
    for (std::size_t i = 0; i < pixels.face.size(); ++i)
        if (!pixels.outside(i)) sum += std::hypot(pixels.dx[i], pixels.dy[i]);
    return sum;
}

}  // namespace

TEST_CASE("masked images: relaxed pixels fold nowhere, stay in the mesh, and keep to the boundary") {
    for (const auto& [name, mask] : sample_masks(40))
        for (const Kind kind : {Kind::kNoise, Kind::kDisc})
            for (const float smoothness : {1e-3f, 30.0f}) {
                INFO(name << ", " << name_of(kind) << ", smoothness " << smoothness);
                Scene s = scene(kind, mask, 60);
                relax(s.pixels, s.mesh, s.fields, s.neighbors, s.feature,
                      {.smoothness = smoothness, .sweeps = 6});
                CHECK(least_area2(s) >= double(least_moving_area(16)) - 1e-4);
                check_boundary(s);
                check_faces(s);
            }
}

TEST_CASE("masked images: pixels do move") {
    for (const int k : {0, 2, 7, 10}) {
        Scene s = scene(Kind::kDisc, sample_masks(60)[static_cast<std::size_t>(k)].mask, 60);
        relax(s.pixels, s.mesh, s.fields, s.neighbors, s.feature, {.smoothness = 30, .sweeps = 8});
        CHECK(total_displacement(s.pixels) > 0.02 * static_cast<double>(s.mask.count()));
    }
}

// The boundaries of a mask with all pixels inside are the image's sides.
TEST_CASE("masked images: a mask with all pixels inside relaxes as if there were none") {
    const Mask full = mask_where(45, 40, [](int, int) { return true; });
    Scene s = scene(Kind::kNoise, Mask{45, 40, {}}, 70), t = s;
    t.pixels = resting_pixels(trivial_map(t.mesh, 45, 40, full), full);
    relax(s.pixels, s.mesh, s.fields, s.neighbors, s.feature, {.smoothness = 30, .sweeps = 5});
    relax(t.pixels, t.mesh, t.fields, t.neighbors, t.feature, {.smoothness = 30, .sweeps = 5});
    CHECK(s.pixels.dx == t.pixels.dx);
    CHECK(s.pixels.dy == t.pixels.dy);
    CHECK(s.pixels.face == t.pixels.face);
}

// Without the bit for free pixels, all pixels move one by one.
TEST_CASE("masked images: eight at a time is one at a time") {
    std::vector<NamedMask> masks = sample_masks(80);
    masks.push_back(
        {"holes of a pixel", mask_where(80, 40, [](int x, int y) { return x % 9 != 4 || y % 5; })});
    const auto same = [](const std::vector<float>& a, const std::vector<float>& b) {
        return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                          [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); });
    };
    for (const auto& [name, mask] : masks) {
        INFO(name);
        Scene s = scene(Kind::kNoise, mask, 90), t = s;
        for (std::uint8_t& freedom : t.pixels.freedom) freedom &= static_cast<std::uint8_t>(~kFree);
        for (Scene* each : {&s, &t})
            relax(each->pixels, each->mesh, each->fields, each->neighbors, each->feature,
                  {.smoothness = 10, .sweeps = 6});
        CHECK(same(s.pixels.dx, t.pixels.dx));
        CHECK(same(s.pixels.dy, t.pixels.dy));
        CHECK(s.pixels.face == t.pixels.face);
    }
}

TEST_CASE("masked images: what is stored has the mask to the pixel and no fold") {
    std::vector<NamedMask> masks = sample_masks(40);
    for (std::uint32_t seed = 1; seed <= 100; ++seed)
        masks.push_back({"random mask " + std::to_string(seed), random_mask(seed)});
    for (const auto& [name, mask] : masks)
        for (const Kind kind : {Kind::kNoise, Kind::kGradient}) {
            INFO(name << ", " << name_of(kind));
            const FeatureImage feature = sample_feature(kind, mask.width, mask.height);
            BaseMesh mesh =
                simplify(grid_mesh(feature, mask), plain_params(), SimplifyTarget{.vertices = 80}).mesh;
            const PixelMap map = fit_map(mesh, feature, {}, {}, mask);
            for (std::size_t i = 0; i < map.size(); ++i)
                if (mask.contains(i) != (map[i].face != kNone)) FAIL_CHECK("pixel " << i);
            const MapQuality q = map_quality(mesh, map, true);
            CHECK(q.pixels == mask.count());
            CHECK(q.unmapped + q.outside_simplex + q.flipped_triangles == 0);
            CHECK(q.min_area2 >= 0.0099);
            // Not a law, because the fit also serves the drawing without the map; but errors must not be
            // close.
            const PixelMap trivial = trivial_map(mesh, mask.width, mask.height, mask);
            CHECK(map_rms(mesh, map, feature) <= 1.02 * map_rms(mesh, trivial, feature) + 1e-3);
        }
}

TEST_CASE("masked images: the same map with any number of threads") {
    const Mask mask = sample_masks(90)[10].mask;
    const FeatureImage feature = sample_feature(Kind::kNoise, 90, 90);
    const auto made = [&] {
        BaseMesh mesh =
            simplify(grid_mesh(feature, mask), plain_params(), SimplifyTarget{.vertices = 300}).mesh;
        return fit_map(mesh, feature, {}, {}, mask).values;
    };
    const std::vector<PixelCoord> first = made();
    for (const int threads : {1, 2, 3}) {
        const ThreadLimit limit(threads);
        CHECK(made() == first);
    }
}
