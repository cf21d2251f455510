// Drawing an image whose pixels have moved.
#include <doctest/doctest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/warp/warp_image.h"
#include "libcore/warp/warp_maps.h"
#include "tests/support/warp_samples.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr int kShapes[][2] = {{1, 1}, {1, 7}, {6, 1}, {2, 2}, {3, 3}, {23, 17}};

Vec2f bend(int x, int y) {
    return {3.3f * std::sin(float(y) / 5), 2.7f * std::cos(float(x) / 4)};
}

struct Hit {
    int rank = 0;
    Vec2d source{0, 0};
};

// The drawing by its definition, trying every triangle for every pixel: no bands, no fast paths, doubles.
// Places are rounded to 1/4096 first, so all products are exact.
std::vector<Hit> slow_map(const DisplacementField& field, int width, int height) {
    const double sx = double(width) / field.width, sy = double(height) / field.height;
    const auto place = [&](int x, int y) {
        const Vec2f move =
            field.move[field.index(std::clamp(x, 0, field.width - 1), std::clamp(y, 0, field.height - 1))];
        const double px = (x + 0.5 + double(move.x())) * sx - 0.5,
                     py = (y + 0.5 + double(move.y())) * sy - 0.5;
        return Vec2d(std::nearbyint(px * 4096), std::nearbyint(py * 4096));
    };
    const auto cross = [](const Vec2d& p, const Vec2d& q, const Vec2d& r) {
        return (q.x() - p.x()) * (r.y() - p.y()) - (q.y() - p.y()) * (r.x() - p.x());
    };
    // Whether r, moved slightly to the right and far less down, is left of p to q.
    const auto inside = [&](const Vec2d& p, const Vec2d& q, const Vec2d& r) {
        const double e = cross(p, q, r);
        return e > 0 || (e == 0 && (q.y() < p.y() || (q.y() == p.y() && q.x() > p.x())));
    };
    std::vector<Hit> hits(static_cast<std::size_t>(width * height));
    const auto draw = [&](std::array<Vec2d, 3> at, std::array<Vec2d, 3> from, bool rim) {
        if (cross(at[0], at[1], at[2]) == 0) return;
        int rank = rim ? 2 : 4;
        if (cross(at[0], at[1], at[2]) < 0) {
            std::swap(at[1], at[2]);
            std::swap(from[1], from[2]);
            --rank;
        }
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const Vec2d p(4096.0 * x, 4096.0 * y);
                Hit& hit = hits[static_cast<std::size_t>(y * width + x)];
                if (rank < hit.rank || !inside(at[0], at[1], p) || !inside(at[1], at[2], p) ||
                    !inside(at[2], at[0], p))
                    continue;
                hit.rank = rank;
                hit.source = (cross(at[1], at[2], p) * from[0] + cross(at[2], at[0], p) * from[1] +
                              cross(at[0], at[1], p) * from[2]) /
                             cross(at[0], at[1], at[2]);
            }
    };
    for (int y = -1; y < field.height; ++y)
        for (int x = -1; x < field.width; ++x) {
            const Vec2d a(x, y), b(x + 1, y), c(x, y + 1), d(x + 1, y + 1);
            const Vec2d pa = place(x, y), pb = place(x + 1, y), pc = place(x, y + 1),
                        pd = place(x + 1, y + 1);
            const bool rim = x < 0 || y < 0 || x + 1 == field.width || y + 1 == field.height;
            if ((cross(pa, pb, pd) <= 0 || cross(pa, pd, pc) <= 0) && cross(pa, pb, pc) > 0 &&
                cross(pb, pd, pc) > 0) {
                draw({pa, pb, pc}, {a, b, c}, rim);
                draw({pb, pd, pc}, {b, d, c}, rim);
            } else {
                draw({pa, pb, pd}, {a, b, d}, rim);
                draw({pa, pd, pc}, {a, d, c}, rim);
            }
        }
    return hits;
}

}  // namespace

TEST_CASE("warp_image: without a move the image comes back to the bit") {
    for (const auto& [w, h] : kShapes)
        for (const int channels : {1, 2, 3, 4, 5}) {
            const Image image = noise_image(w, h, channels);
            const Image out = warp_image(image, field_of(w, h, [](int, int) { return Vec2f(0, 0); }));
            CHECK(out.data == image.data);
            CHECK(out.channel_names == image.channel_names);
        }
}

TEST_CASE("warp_image: whole moves shift the image to the bit, and the rest is clear") {
    for (const auto& [w, h] : kShapes)
        for (const auto& [dx, dy] : {std::pair(1, 0), {-2, 3}, {0, -1}}) {
            const Image image = noise_image(w, h, 3);
            const Vec2f move(static_cast<float>(dx), static_cast<float>(dy));
            const Image out = warp_image(image, field_of(w, h, [&](int, int) { return move; }));
            REQUIRE(out.channels == 4);
            for (int y = 0; y < h; ++y)
                for (int x = 0; x < w; ++x) {
                    const bool shown = x - dx >= 0 && x - dx < w && y - dy >= 0 && y - dy < h;
                    CHECK(out.pixel(x, y)[3] == (shown ? 1.0f : 0.0f));
                    if (shown)
                        CHECK(std::equal(out.pixel(x, y), out.pixel(x, y) + 3, image.pixel(x - dx, y - dy)));
                }
        }
}

// The same triangles, found slowly: bends, folds, scalings, and cells from nearly undistorted to huge.
TEST_CASE("inverse_map: agrees with every triangle tried for every pixel") {
    std::mt19937 random(3);
    const auto noise = [&](float reach) {
        return [&random, reach](int, int) {
            const auto one = [&] { return reach * (static_cast<float>(random() % 2001) / 1000 - 1); };
            const float x = one();
            return Vec2f(x, one());
        };
    };
    for (const auto& [w, h] : kShapes)
        for (const OutputSize size : {OutputSize{0, 0}, {11, 9}, {40, 30}})
            for (const float reach : {0.04f, 0.4f, 6.0f, -1.0f}) {
                DisplacementField field = field_of(w, h, bend);
                if (reach > 0) field = field_of(w, h, noise(reach));
                const InverseMap map = inverse_map(field, {}, size);
                const std::vector<Hit> slow = slow_map(field, map.width, map.height);
                double worst = 0;
                int differ = 0;
                for (std::size_t i = 0; i < slow.size(); ++i) {
                    if (slow[i].rank == 0) differ += map.coverage[i] != 0;
                    worst = std::max(worst, (slow[i].source - map.source[i].cast<double>()).norm());
                }
                CHECK(differ == 0);
                CHECK(worst < 1e-4);
            }
}

// The inverse of an affine map is known.
TEST_CASE("inverse_map: undoes a turn with scaling") {
    Eigen::Matrix2d m;
    m << 1.4, 0.5, -0.3, 0.9;
    const Vec2d center(15, 12);
    const auto move = [&](int x, int y) {
        const Vec2d p(x, y);
        return Vec2f((m * (p - center) + center - p).cast<float>());
    };
    const InverseMap map = inverse_map(field_of(31, 25, move), {});
    int seen = 0;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const auto i = static_cast<std::size_t>(y * map.width + x);
            const Vec2d expected = m.inverse() * (Vec2d(x, y) - center) + center;
            const Vec2d out = (expected - Vec2d(15, 12)).cwiseAbs() - Vec2d(15.5, 12.5);
            if (out.maxCoeff() > 0.5) CHECK(map.coverage[i] < 0.5f);
            if (out.maxCoeff() > -0.9) continue;
            CHECK((map.source[i].cast<double>() - expected).norm() < 1e-3);
            CHECK(map.coverage[i] == 1);
            ++seen;
        }
    CHECK(seen > 200);
}

// Bilinear interpolation reproduces functions that are linear in x and y.
TEST_CASE("warp_image: colours are those of where a pixel comes from") {
    Image image = make_image(30, 20, 2);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 30; ++x) {
            image.pixel(x, y)[0] = 0.1f * static_cast<float>(x) - static_cast<float>(y);
            image.pixel(x, y)[1] = 1;
        }
    const DisplacementField field = field_of(30, 20, [](int x, int y) { return Vec2f(0.2f * bend(x, y)); });
    const Image out = warp_image(image, field, {60, 50});
    const InverseMap map = inverse_map(field, {}, {60, 50});
    int seen = 0;
    for (int y = 4; y < 46; ++y)
        for (int x = 4; x < 56; ++x) {
            const Vec2f from = map.source[static_cast<std::size_t>(y * 60 + x)];
            CHECK(out.pixel(x, y)[0] == doctest::Approx(0.1f * from.x() - from.y()).epsilon(1e-4));
            ++seen;
        }
    CHECK(seen > 0);
}

TEST_CASE("warp_image: half the size is the mean of two by two pixels") {
    const Image image = noise_image(8, 6, 3);
    const Image out = warp_image(image, field_of(8, 6, [](int, int) { return Vec2f(0, 0); }), {4, 3});
    REQUIRE(out.channels == 3);
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 3; ++c) {
                const float mean = (image.pixel(2 * x, 2 * y)[c] + image.pixel(2 * x + 1, 2 * y)[c] +
                                    image.pixel(2 * x, 2 * y + 1)[c] + image.pixel(2 * x + 1, 2 * y + 1)[c]) /
                                   4;
                CHECK(out.pixel(x, y)[c] == doctest::Approx(mean).epsilon(1e-5));
            }
}

// Places are rounded to 1/4096 pixel, which must not show as a transparent side.
TEST_CASE("warp_image: another size alone leaves nothing clear") {
    for (const auto& [w, h] : kShapes)
        for (const OutputSize size : {OutputSize{1, 1}, {100, 7}, {5, 90}, {29, 31}, {230, 170}}) {
            const Image out =
                warp_image(noise_image(w, h, 3), field_of(w, h, [](int, int) { return Vec2f(0, 0); }), size);
            CHECK(out.channels == 3);
        }
}

// One sample a pixel would give stripes.
TEST_CASE("warp_image: fine stripes become grey where moves shrink them") {
    Image image = make_image(64, 64, 1);
    for (int i = 0; i < 64 * 64; ++i) image.data[static_cast<std::size_t>(i)] = static_cast<float>(i % 2);
    const DisplacementField field = field_of(
        64, 64, [](int x, int y) { return Vec2f(0.76f * (31.5f - float(x)), 0.76f * (31.5f - float(y))); });
    const Image out = warp_image(image, field);
    for (int y = 26; y < 38; ++y)
        for (int x = 26; x < 38; ++x) CHECK(std::abs(out.pixel(x, y)[0] - 0.5f) < 0.13f);
}

TEST_CASE("warp_image: folds show what is not turned over, then the later row") {
    Image image = make_image(6, 6, 1);
    for (int i = 0; i < 36; ++i) image.data[static_cast<std::size_t>(i)] = static_cast<float>(i);
    // Places of columns or rows 0 to 5: 0 1 2 | 0 1 2, turned over in between.
    const Image rows = warp_image(image, field_of(6, 6, [](int, int y) { return Vec2f(0, y < 3 ? 0 : -3); }));
    const Image columns =
        warp_image(image, field_of(6, 6, [](int x, int) { return Vec2f(x < 3 ? 0 : -3, 0); }));
    // 0 1 2 3 and back to 2.
    const Image back = warp_image(image, field_of(6, 6, [](int x, int) {
                                      return Vec2f(static_cast<float>(x < 4 ? 0 : 6 - 2 * x), 0);
                                  }));
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 2; ++k) {
            CHECK(rows.pixel(i, k)[0] == static_cast<float>((k + 3) * 6 + i));
            CHECK(columns.pixel(k, i)[0] == static_cast<float>(i * 6 + k + 3));
            // In the last row both are boundaries, and the rim beside the fold is not turned over.
            if (i < 5) CHECK(back.pixel(k + 1, i)[0] == static_cast<float>(i * 6 + k + 1));
        }
    CHECK(folded_cells(field_of(6, 6, [](int, int y) { return Vec2f(0, y < 3 ? 0 : -3); })) == 5);
}

TEST_CASE("warp_image: sides that move cover shares of pixels") {
    Image image = make_image(4, 4, 3);
    std::fill(image.data.begin(), image.data.end(), 0.5f);
    const Image out = warp_image(image, field_of(4, 4, [](int, int) { return Vec2f(0.25f, -0.5f); }));
    REQUIRE(out.channels == 4);
    CHECK(out.channel_names.back() == "A");
    CHECK(out.pixel(0, 1)[3] == 0.75f);
    CHECK(out.pixel(2, 1)[3] == 1);
    CHECK(out.pixel(2, 3)[3] == 0.5f);
    CHECK(out.pixel(0, 3)[3] == 0.375f);
    CHECK(out.pixel(0, 3)[1] == doctest::Approx(0.5f));
}

// Pixels pressed against a resting side have footprints that reach beyond it; the side is still where it was.
TEST_CASE("warp_image: a side that rests is opaque") {
    const auto pressed = [](int at, int side) {
        const int from = std::min(at, side - 1 - at);
        return (at < side / 2 ? -0.8f : 0.8f) * static_cast<float>(std::min(from, 3));
    };
    const DisplacementField field =
        field_of(30, 24, [&](int x, int y) { return Vec2f(pressed(x, 30), pressed(y, 24)); });
    for (const OutputSize size : {OutputSize{0, 0}, {15, 12}, {75, 60}})
        CHECK(warp_image(noise_image(30, 24, 3), field, size).channels == 3);
}

TEST_CASE("warp_image: masked images keep their alpha, soft boundaries included") {
    MeshImage m = grid_pyramid(24, 20, {5});
    const auto distance = [](int x, int y) { return std::hypot(x - 11.5, y - 9.5); };
    apply_mask(m, [&](int x, int y) { return distance(x, y) < 6; });
    Image soft = noise_image(24, 20, 4);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x)
            soft.pixel(x, y)[3] = static_cast<float>(std::clamp(6.5 - distance(x, y), 0.0, 1.0));
    Image hard = noise_image(24, 20, 3);

    const VertexMoves all(m.levels[0].mesh.vertex_count(), Vec2f(3, 2));
    const DisplacementField field = displacement_field(m, {all});
    const Image shifted_soft = warp_image(soft, field), shifted_hard = warp_image(hard, field);
    REQUIRE(shifted_hard.channels == 4);
    for (int y = 2; y < 20; ++y)
        for (int x = 3; x < 24; ++x) {
            const float* from = soft.pixel(x - 3, y - 2);
            const float* to = shifted_soft.pixel(x, y);
            CHECK(to[3] == from[3]);
            if (from[3] > 0) CHECK(std::equal(to, to + 3, from));
            const bool inside = distance(x - 3, y - 2) < 6;
            CHECK(shifted_hard.pixel(x, y)[3] == (inside ? 1.0f : 0.0f));
            if (inside) CHECK(std::equal(to, to + 3, from));
        }
    // Nothing moves: hidden colours stay too.
    const DisplacementField rest = displacement_field(m, {{}});
    CHECK(warp_image(soft, rest).data == soft.data);
    const Image cut = warp_image(hard, rest);
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 24; ++x) {
            CHECK(cut.pixel(x, y)[3] == (distance(x, y) < 6 ? 1.0f : 0.0f));
            CHECK(std::equal(cut.pixel(x, y), cut.pixel(x, y) + 3, hard.pixel(x, y)));
        }
}

// Colours outside must not bleed in, wherever the boundary moves.
TEST_CASE("warp_image: what is outside shows nowhere") {
    MeshImage m = grid_pyramid(40, 30, {6});
    apply_mask(m, [](int x, int y) { return (x / 3 + y / 4) % 2 == 0 && x != 20; });
    Image image = make_image(40, 30, 3);
    for (int y = 0; y < 30; ++y)
        for (int x = 0; x < 40; ++x) {
            const bool inside = m.levels[0].map.row(y)[static_cast<std::size_t>(x)].face != kNone;
            std::fill_n(image.pixel(x, y), 3, inside ? 0.25f : 1000.0f);
        }
    VertexMoves moves(m.levels[0].mesh.vertex_count());
    for (Id v = 0; v < moves.size(); ++v) moves[v] = bend(static_cast<int>(v) * 3, static_cast<int>(v));
    const DisplacementField field = displacement_field(m, {moves});
    for (const OutputSize size : {OutputSize{0, 0}, {17, 12}, {90, 95}}) {
        const Image out = warp_image(image, field, size);
        float visible = 0;
        for (int y = 0; y < out.height; ++y)
            for (int x = 0; x < out.width; ++x) {
                const float* p = out.pixel(x, y);
                visible += p[3];
                if (p[3] > 0) CHECK(p[1] == doctest::Approx(0.25f));
            }
        CHECK(visible > 50);
    }
}

TEST_CASE("warp_image: same bytes for any number of threads") {
    const Image image = noise_image(150, 170, 3);
    const DisplacementField field = field_of(150, 170, [](int x, int y) { return Vec2f(4 * bend(x, y)); });
    Image one;
    {
        const ThreadLimit limit(1);
        one = warp_image(image, field, {140, 200});
    }
    CHECK(warp_image(image, field, {140, 200}).data == one.data);
}

TEST_CASE("warp_image: extreme moves draw something or nothing, and end") {
    for (const float far : {1e6f, 1e30f, std::numeric_limits<float>::max()}) {
        const Image out = warp_image(noise_image(9, 8, 3), field_of(9, 8, [&](int x, int y) {
                                         return (x + y) % 2 ? Vec2f(far, -far) : Vec2f(0, 0);
                                     }));
        CHECK(out.width == 9);
        for (const float value : out.data) CHECK(std::isfinite(value));
    }
}

TEST_CASE("warp_image: other sizes are refused") {
    const DisplacementField field = field_of(9, 8, [](int, int) { return Vec2f(0, 0); });
    CHECK_THROWS_AS(warp_image(noise_image(8, 9, 3), field), Error);
    for (const OutputSize size : {OutputSize{0, 5}, {5, 0}, {-1, 5}, {65536, 1}, {65535, 65535}})
        CHECK_THROWS_AS(warp_image(noise_image(9, 8, 3), field, size), Error);
}

TEST_CASE("st_map_image: the identity is a pair of ramps") {
    const DisplacementField field = field_of(4, 5, [](int, int) { return Vec2f(0, 0); });
    const Image map = st_map_image(inverse_map(field, {}), 4, 5);
    CHECK(map.channel_names == std::vector<std::string>{"R", "G", "A"});
    CHECK(map.pixel(0, 4)[0] == doctest::Approx(0.125f));
    CHECK(map.pixel(0, 4)[1] == doctest::Approx(0.1f));
    CHECK(map.pixel(3, 0)[0] == doctest::Approx(0.875f));
    CHECK(map.pixel(3, 0)[1] == doctest::Approx(0.9f));
    CHECK(map.pixel(2, 2)[2] == 1);
    // Shifted right by one, the left column shows nothing.
    const DisplacementField right = field_of(4, 5, [](int, int) { return Vec2f(1, 0); });
    const Image moved = st_map_image(inverse_map(right, {}), 4, 5);
    CHECK(moved.pixel(0, 0)[2] == 0);
    CHECK(moved.pixel(1, 0)[0] == doctest::Approx(0.125f));
    const Image forward = forward_map_image(right);
    CHECK(forward.channel_names == std::vector<std::string>{"displacement.x", "displacement.y"});
    CHECK(forward.pixel(3, 4)[0] == 1);
    CHECK(forward.pixel(3, 4)[1] == 0);
}
