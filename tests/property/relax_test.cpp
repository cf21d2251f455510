// What must hold for the relaxed pixel map of any image.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "libcore/base/parallel.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/param/relax.h"
#include "libcore/simplify/simplify.h"
#include "tests/support/sample_pictures.h"
#include "tests/support/simplify_params.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

// An image, its base mesh at `vertices`, and its pixels at rest.
struct Scene {
    FeatureImage feature;
    BaseMesh mesh;
    std::vector<FaceField> fields;
    std::vector<Face> neighbors;
    PixelEmbedding pixels;
};

Scene scene(FeatureImage feature, std::int64_t vertices) {
    Scene out;
    out.feature = std::move(feature);
    out.mesh = simplify(grid_mesh(out.feature), plain_params(), SimplifyTarget{.vertices = vertices}).mesh;
    out.fields = face_fields(out.mesh);
    out.neighbors = face_neighbors(out.mesh);
    out.pixels = resting_pixels(trivial_map(out.mesh, out.feature.width, out.feature.height));
    return out;
}

void relax(Scene& s, const RelaxParams& params) {
    imgmesh::relax(s.pixels, s.mesh, s.fields, s.neighbors, s.feature, params);
}
void relax(Scene& s, float smoothness, int sweeps) {
    relax(s, {.smoothness = smoothness, .sweeps = sweeps});
}

// The least of the four triangles of any cell, in whole squares of the grid. Fails if a pixel is off the
// grid.
std::int64_t least_area2(const PixelEmbedding& pixels, int steps) {
    const Displacements d = displacements(pixels, steps);
    using Point = std::array<std::int64_t, 2>;
    const auto place = [&](int x, int y) {
        const std::size_t i = pixels.index(x, y);
        REQUIRE(static_cast<float>(d.dx[i]) == pixels.dx[i] * static_cast<float>(steps));
        REQUIRE(static_cast<float>(d.dy[i]) == pixels.dy[i] * static_cast<float>(steps));
        return Point{std::int64_t{x} * steps + d.dx[i], std::int64_t{y} * steps + d.dy[i]};
    };
    const auto area2 = [](const Point& p, const Point& q, const Point& r) {
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    };
    std::int64_t least = std::int64_t{steps} * steps;
    for (int y = 0; y + 1 < pixels.height; ++y)
        for (int x = 0; x + 1 < pixels.width; ++x) {
            const Point a = place(x, y), b = place(x + 1, y), c = place(x + 1, y + 1), e = place(x, y + 1);
            least = std::min({least, area2(a, b, c), area2(b, c, e), area2(c, e, a), area2(e, a, b)});
        }
    return least;
}
void check_areas(const PixelEmbedding& pixels, int steps = RelaxParams().steps) {
    CHECK(static_cast<double>(least_area2(pixels, steps)) >=
          double{least_moving_area(steps)} * steps * steps);
}

void check_border(const PixelEmbedding& pixels) {
    const int right = pixels.width - 1, bottom = pixels.height - 1;
    for (int y = 0; y <= bottom; ++y)
        for (int x = 0; x <= right; ++x) {
            const Vec2f p = pixels.image_of(x, y);
            if (x == 0 || x == right) CHECK(p.x() == static_cast<float>(x));
            if (y == 0 || y == bottom) CHECK(p.y() == static_cast<float>(y));
        }
}

// Each pixel's face is the one that it lies in, up to rounding.
void check_faces(const Scene& s) {
    for (int y = 0; y < s.pixels.height; ++y)
        for (int x = 0; x < s.pixels.width; ++x) {
            const Vec2f p = s.pixels.image_of(x, y);
            REQUIRE(s.pixels.face[s.pixels.index(x, y)] < s.fields.size());
            const FaceField& field = s.fields[s.pixels.face[s.pixels.index(x, y)]];
            const float u = field.u(p.x(), p.y()), v = field.v(p.x(), p.y());
            CHECK(std::min({u, v, 1 - u - v}) >= -1e-4f);
        }
}

// Root mean square distance between the pixels' colours and the mesh's where they lie.
double rms(const Scene& s) {
    double sum = 0;
    for (int y = 0; y < s.pixels.height; ++y)
        for (int x = 0; x < s.pixels.width; ++x) {
            const std::size_t index = s.pixels.index(x, y);
            const FaceField& field = s.fields[s.pixels.face[index]];
            const Vec2f p = s.pixels.image_of(x, y);
            for (int c = 0; c < 3; ++c) {
                const double e = double(field.f[c]) + double(field.fx[c] * (p.x() - field.ax)) +
                                 double(field.fy[c] * (p.y() - field.ay)) - double(s.feature.pixel(index)[c]);
                sum += e * e;
            }
        }
    return std::sqrt(sum / static_cast<double>(s.pixels.face.size()));
}

}  // namespace

TEST_CASE("relax: no triangle of pixels folds or thins out, however soft or hard the grid") {
    for (const Kind kind : kAllKinds)
        for (const float smoothness : {1e-12f, 1e-3f, 1.0f, 30.0f, 1e6f, 1e30f}) {
            Scene s = scene(sample_feature(kind, 33, 26), 40);
            for (int round = 0; round < 4; ++round) {
                INFO(name_of(kind) << ", smoothness " << smoothness << ", round " << round);
                relax(s, smoothness, 3);
                check_areas(s.pixels);
                check_border(s.pixels);
                check_faces(s);
            }
        }
}

// Shifts of the pixels of a line, as far as they may go: ascending places, less than a pixel beside the ends.
std::vector<float> random_shifts(int length, std::mt19937& random) {
    std::vector<float> shifts(as_index(length), 0.0f);
    for (std::size_t k = 1; k + 1 < shifts.size(); ++k) {
        const auto place = static_cast<float>(random() % 56) / 8 - 3.5f;
        shifts[k] = std::max(k == 1 ? -0.875f : shifts[k - 1] - 0.875f, place);
    }
    for (std::size_t k = shifts.size() - 1; k-- > 1;)
        shifts[k] = std::min(shifts[k], k + 2 == shifts.size() ? 0.875f : shifts[k + 1] + 0.875f);
    shifts[1] = std::min(shifts[1], 0.875f);
    if (shifts.size() > 2) shifts[shifts.size() - 2] = std::max(shifts[shifts.size() - 2], -0.875f);
    return shifts;
}

TEST_CASE("relax: pixels of a tile's sides stay where they are put, and no triangle folds") {
    std::mt19937 random(5);
    for (const Kind kind : kAllKinds)
        for (const std::pair<int, int>& size : {std::pair{33, 26}, {70, 21}, {2, 30}, {3, 3}, {40, 2}}) {
            const int w = size.first, h = size.second;
            INFO(name_of(kind) << " " << w << " x " << h);
            Scene s = scene(sample_feature(kind, w, h), std::max(4, w * h / 20));
            TileSides sides;
            for (Side* side : {&sides.top, &sides.bottom}) side->shifts = random_shifts(w, random);
            for (Side* side : {&sides.left, &sides.right}) side->shifts = random_shifts(h, random);
            place_sides(s.pixels, sides, s.fields, s.neighbors);
            const auto check = [&] {
                for (int x = 0; x < w; ++x) {
                    CHECK(s.pixels.dx[s.pixels.index(x, 0)] == sides.top.shifts[as_index(x)]);
                    CHECK(s.pixels.dx[s.pixels.index(x, h - 1)] == sides.bottom.shifts[as_index(x)]);
                }
                for (int y = 0; y < h; ++y) {
                    CHECK(s.pixels.dy[s.pixels.index(0, y)] == sides.left.shifts[as_index(y)]);
                    CHECK(s.pixels.dy[s.pixels.index(w - 1, y)] == sides.right.shifts[as_index(y)]);
                }
                // In a corner an eighth of a pixel each way may be left.
                CHECK(least_area2(s.pixels, kUsualSteps) >= kUsualSteps * kUsualSteps / 64);
                check_border(s.pixels);
                check_faces(s);
            };
            check();
            relax(s, 5, 6);
            check();
        }
}

TEST_CASE("relax: on every grid and at every rate, pixels stay on it and no triangle folds") {
    for (const Kind kind : {Kind::kNoise, Kind::kDisc, Kind::kCheckerboard})
        for (const int steps : {8, 16, 32})
            for (const float rate : {0.0f, 0.1f, 10.0f}) {
                INFO(name_of(kind) << ", " << steps << " steps, rate " << rate);
                Scene s = scene(sample_feature(kind, 50, 26), 40);
                relax(s, {.smoothness = 5, .steps = steps, .rate = rate, .sweeps = 8});
                check_areas(s.pixels, steps);
                check_border(s.pixels);
                check_faces(s);
            }
}

// As docs/decisions/0034-compact-map.md has it, the residuals of a median prediction stand for the bits.
TEST_CASE("relax: a higher rate leaves smaller residuals") {
    double last = 1e9;
    for (const float rate : {0.0f, 0.5f, 5.0f, 50.0f}) {
        Scene s = scene(sample_feature(Kind::kDisc, 60, 40), 60);
        relax(s, {.smoothness = 10, .rate = rate, .sweeps = 16});
        const Displacements d = displacements(s.pixels, 16);
        double bits = 0;
        for (int y = 1; y < 40; ++y)
            for (int x = 1; x < 60; ++x)
                for (const std::vector<std::int16_t>* of : {&d.dx, &d.dy}) {
                    const auto at = [&](int i, int j) { return int{(*of)[d.index(i, j)]}; };
                    const int w = at(x - 1, y), n = at(x, y - 1), nw = at(x - 1, y - 1);
                    const int median = std::max(std::min(w, n), std::min(std::max(w, n), w + n - nw));
                    bits += std::log2(1.0 + std::abs(at(x, y) - median));
                }
        INFO("rate " << rate << ": " << bits << " bits");
        CHECK(bits < 0.9 * last);
        last = bits;
    }
}

// Grey images with steep diagonals make J'J singular and large: only mu remains, and rounding may hide it.
TEST_CASE("relax: a steep grey edge against the softest grid") {
    FeatureImage feature{32, 32, 3, std::vector<float>(3 * 32 * 32)};
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x)
            feature.pixel(static_cast<std::size_t>(32 * y + x))[0] = x + y > 30 ? 100 : 0;
    for (const float smoothness : {1e-30f, 1e-12f, 1e-6f, 1e-3f}) {
        INFO("smoothness " << smoothness);
        Scene s = scene(feature, 60);
        relax(s, smoothness, 8);
        check_areas(s.pixels);
        check_border(s.pixels);
        check_faces(s);
    }
}

TEST_CASE("relax: small images, and those of two columns or rows") {
    for (const auto& [w, h] : {std::pair{2, 2}, {2, 9}, {9, 2}, {3, 3}, {5, 4}}) {
        INFO(w << " x " << h);
        Scene s = scene(sample_feature(Kind::kNoise, w, h), 4);
        relax(s, 1, 20);
        check_areas(s.pixels);
        check_border(s.pixels);
    }
}

TEST_CASE("relax: steps longer than Newton's arrive sooner, and fold nothing") {
    const Scene start = scene(sample_feature(Kind::kDisc, 60, 50), 40);
    double last = 1e9;
    for (const float stride : {1.0f, 1.6f}) {
        Scene s = start;
        relax(s, {.smoothness = 30, .sweeps = 3, .stride = stride});
        check_areas(s.pixels);
        check_faces(s);
        CHECK(rms(s) < last);
        last = rms(s);
    }
}

TEST_CASE("relax: pixels move to where the mesh has their colour") {
    for (const Kind kind : {Kind::kDisc, Kind::kNoise, Kind::kCheckerboard, Kind::kGradient}) {
        INFO(name_of(kind));
        Scene s = scene(sample_feature(kind, 33, 26), 40);
        const double at_rest = rms(s);
        relax(s, 30, 16);
        CHECK(rms(s) < at_rest);
        if (kind == Kind::kDisc) CHECK(rms(s) < 0.9 * at_rest);
    }
}

TEST_CASE("relax: a harder grid moves less, and one without colour not at all") {
    double last = 1e9;
    for (const float smoothness : {10.0f, 1e3f, 1e6f}) {
        Scene s = scene(sample_feature(Kind::kDisc, 33, 26), 40);
        relax(s, smoothness, 16);
        double moved = 0;
        for (std::size_t i = 0; i < s.pixels.dx.size(); ++i)
            moved += std::hypot(double(s.pixels.dx[i]), double(s.pixels.dy[i]));
        CHECK(moved < last);
        last = moved;
    }
    Scene flat = scene(sample_feature(Kind::kConstant, 20, 20), 30);
    relax(flat, 30, 8);
    for (const std::vector<float>* d : {&flat.pixels.dx, &flat.pixels.dy})
        for (const float moved : *d) CHECK(std::abs(moved) < 1e-3f);
}

TEST_CASE("relax: the same bits for any number of threads") {
    // Tall enough for several blocks of rows.
    const Scene start = scene(sample_feature(Kind::kNoise, 40, 150), 200);
    Scene one = start;
    {
        const ThreadLimit limit(1);
        relax(one, 10, 8);
    }
    for (const int threads : {2, 3}) {
        const ThreadLimit limit(threads);
        Scene other = start;
        relax(other, 10, 8);
        CHECK(other.pixels.dx == one.pixels.dx);
        CHECK(other.pixels.dy == one.pixels.dy);
        CHECK(other.pixels.face == one.pixels.face);
    }
}

// With three features pixels move side by side, else one by one. A fourth feature that is zero everywhere
// changes no sum.
TEST_CASE("relax: pixels side by side move like one by one, to the bit") {
    int scenes = 0;
    for (const Kind kind : {Kind::kNoise, Kind::kDisc, Kind::kCheckerboard})
        for (const float smoothness : {1e-3f, 1.0f, 30.0f})
            for (const float rate : {0.0f, 1.0f}) {
                const int width = rate > 0 ? 75 : 78 - scenes++ % 7;  // the last lanes overlap or not
                INFO(name_of(kind) << ", smoothness " << smoothness << ", rate " << rate << ", " << width);
                Scene wide = scene(sample_feature(kind, width, 24), 100);
                Scene single = wide;
                single.feature.channels = single.mesh.channels = 4;
                const auto with_zero = [](std::vector<float>& of_three) {
                    std::vector<float> four;
                    for (std::size_t i = 0; i < of_three.size(); ++i) {
                        four.push_back(of_three[i]);
                        if (i % 3 == 2) four.push_back(0);
                    }
                    of_three = four;
                };
                with_zero(single.feature.data);
                with_zero(single.mesh.feature);
                const RelaxParams params{
                    .smoothness = smoothness, .rate = rate, .sweeps = 4, .stride = rate > 0 ? 1 : 1.6f};
                relax(wide, params);
                relax(single, params);
                CHECK(wide.pixels.dx == single.pixels.dx);
                CHECK(wide.pixels.dy == single.pixels.dy);
                CHECK(wide.pixels.face == single.pixels.face);
            }
}

TEST_CASE("face fields: weights and colours at the corners, neighbours across the edges") {
    const Scene s = scene(sample_feature(Kind::kNoise, 20, 20), 40);
    for (std::size_t f = 0; f < s.mesh.faces.size(); ++f) {
        const FaceField& field = s.fields[f];
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec2f p = s.mesh.position[s.mesh.faces[f][k]];
            CHECK(field.u(p.x(), p.y()) == doctest::Approx(k == 1 ? 1 : 0).epsilon(1e-4));
            CHECK(field.v(p.x(), p.y()) == doctest::Approx(k == 2 ? 1 : 0).epsilon(1e-4));
            for (int c = 0; c < 3; ++c)
                CHECK(field.f[c] + field.fx[c] * (p.x() - field.ax) + field.fy[c] * (p.y() - field.ay) ==
                      doctest::Approx(s.mesh.feature_of(s.mesh.faces[f][k])[c]).epsilon(1e-3));
            // The face across the edge opposite corner k has its two ends, the other way round.
            const Id across = s.neighbors[f][k], from = s.mesh.faces[f][(k + 1) % 3],
                     to = s.mesh.faces[f][(k + 2) % 3];
            int seen = 0;
            for (std::size_t g = 0; g < s.mesh.faces.size(); ++g)
                for (std::size_t m = 0; m < 3; ++m)
                    if (s.mesh.faces[g][m] == to && s.mesh.faces[g][(m + 1) % 3] == from) {
                        CHECK(across == g);
                        ++seen;
                    }
            if (seen == 0) CHECK(across == kNone);
        }
    }
}

TEST_CASE("locate_face: from any face to the one that holds the point") {
    const Scene s = scene(sample_feature(Kind::kDisc, 20, 20), 40);
    std::mt19937 random(1);
    for (int n = 0; n < 500; ++n) {
        const Vec2f p(static_cast<float>(random() % 1901) / 100, static_cast<float>(random() % 1901) / 100);
        const FaceField& field =
            s.fields[locate_face(p, static_cast<Id>(random() % s.fields.size()), s.fields, s.neighbors)];
        const float u = field.u(p.x(), p.y()), v = field.v(p.x(), p.y());
        CHECK(std::min({u, v, 1 - u - v}) >= -1e-5f);
    }
}
