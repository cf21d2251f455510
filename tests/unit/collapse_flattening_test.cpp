// How points of the triangles around an edge are carried through its collapse.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <random>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/edit_mesh.h"
#include "libcore/param/collapse_flattening.h"

using namespace imgmesh;

namespace {

constexpr int kSide = 6;        // vertices a side
constexpr int kDimensions = 5;  // position and three features

std::size_t index(int k) {
    return static_cast<std::size_t>(k);
}

// A grid whose vertices lie beside their places, with diagonals at random: all that a collapse sees.
struct Sample {
    std::vector<float> points;
    std::vector<Face> faces;

    Sample(float features, std::mt19937& random) {
        std::uniform_real_distribution<float> beside(-0.3f, 0.3f), feature(-features, features);
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                const bool free_x = x > 0 && x + 1 < kSide, free_y = y > 0 && y + 1 < kSide;
                points.push_back(static_cast<float>(x) + (free_x ? beside(random) : 0));
                points.push_back(static_cast<float>(y) + (free_y ? beside(random) : 0));
                for (int c = 2; c < kDimensions; ++c) points.push_back(feature(random));
            }
        for (int y = 0; y + 1 < kSide; ++y)
            for (int x = 0; x + 1 < kSide; ++x) {
                const Id a = static_cast<Id>(y * kSide + x), b = a + 1, c = a + kSide, d = c + 1;
                const bool falling = random() % 2 == 0;
                faces.push_back(falling ? Face{a, c, d} : Face{a, c, b});
                faces.push_back(falling ? Face{a, d, b} : Face{b, c, d});
            }
    }
    Vec2d place(Id v) const { return {double(points[v * kDimensions]), double(points[v * kDimensions + 1])}; }
};

// One collapse: its ends, what they become, and the layouts of it.
struct Collapse {
    const Sample& sample;
    std::array<OneRing, 2> stars;
    std::array<float, kDimensions> merged{};
    CollapseFlattening flat;
    bool done;

    // The merged vertex lies between the ends, at the share `along` from i to j and `across` beside that.
    Collapse(const Sample& from, Id i, Id j, double along, double across) : sample(from) {
        const EditMesh mesh(from.faces, index(kSide * kSide));
        mesh.ring(i, stars[0]);
        mesh.ring(j, stars[1]);
        for (std::size_t c = 0; c < kDimensions; ++c)
            merged[c] = static_cast<float>((1 - along) * double(sample.points[i * kDimensions + c]) +
                                           along * double(sample.points[j * kDimensions + c]));
        const Vec2d edge = sample.place(j) - sample.place(i);
        merged[0] += static_cast<float>(-across * edge.y());
        merged[1] += static_cast<float>(across * edge.x());
        done = flat.lay_out({&stars[0], &stars[1]}, sample.points.data(), merged.data(), kDimensions, true);
    }

    int faces(int star) const { return static_cast<int>(stars[index(star)].faces); }
    Vec2d middle() const { return {double(merged[0]), double(merged[1])}; }
    Vec2d ring_place(int star, int k) const { return sample.place(stars[index(star)].vertex[index(k)]); }
    // Where a point of the triangles before, or of those after, is in the plane.
    Vec2d before(const StarPoint& p) const {
        const auto& w = p.at.weight;
        return w[0] * sample.place(stars[index(p.star)].center) + w[1] * ring_place(p.star, p.at.triangle) +
               w[2] * ring_place(p.star, p.at.triangle + 1);
    }
    Vec2d after(const StarPoint& p) const {
        const auto& w = p.at.weight;
        return w[0] * middle() + w[1] * ring_place(p.star, p.at.triangle) +
               w[2] * ring_place(p.star, p.at.triangle + 1);
    }
    // The least twice-area of the triangles that survive, with the merged vertex in the place of their end.
    double least_area() const {
        double least = 1e9;
        const Vec2f m = middle().cast<float>();
        for (int s = 0; s < 2; ++s)
            for (int k = 0; k < faces(s); ++k)
                if (!flat.is_shared(s, k))
                    least = std::min(least, signed_area2(m, ring_place(s, k).cast<float>(),
                                                         ring_place(s, k + 1).cast<float>()));
        return least;
    }
    // Whether carry() takes the point: all but those of the rest of a star that rests.
    bool moves(const StarPoint& p) const {
        return !flat.rests(p.star) || flat.is_shared(p.star, p.at.triangle);
    }
};

// Calls body(sample, i, j, random) for the edges of several grids, for inner ones in both directions.
void for_each_edge(float features, const std::function<void(const Sample&, Id, Id, std::mt19937&)>& body) {
    std::mt19937 random(7);
    for (int repeat = 0; repeat < 12; ++repeat) {
        const Sample sample(features, random);
        for (const Face& f : sample.faces)
            for (std::size_t k = 0; k < 3; ++k) body(sample, f[k], f[(k + 1) % 3], random);
    }
}

bool corner(Id v) {
    const Id x = v % kSide, y = v / kSide;
    return (x == 0 || x + 1 == kSide) && (y == 0 || y + 1 == kSide);
}
bool border(Id v) {
    const Id x = v % kSide, y = v / kSide;
    return x == 0 || x + 1 == kSide || y == 0 || y + 1 == kSide;
}
// Both on one side of the grid.
bool border_edge(Id i, Id j) {
    const auto side = [](Id v, Id w) { return v == w && (v == 0 || v + 1 == kSide); };
    return side(i % kSide, j % kSide) || side(i / kSide, j / kSide);
}
// What a simplifier would not collapse: a corner, or two sides that would touch.
bool forbidden(Id i, Id j) {
    return corner(i) || corner(j) || (border(i) && border(j) && !border_edge(i, j));
}

// A share of the way from i to j: on a border that only one end is on, the end itself.
double random_along(Id i, Id j, std::mt19937& random) {
    if (border(i) != border(j)) return border(i) ? 0 : 1;
    const double shares[] = {0, 1, std::uniform_real_distribution<double>(0.1, 0.9)(random)};
    return shares[random() % 3];
}

std::array<double, 3> random_weights(std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    double u = uniform(random), v = uniform(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return {1 - u - v, u, v};
}

}  // namespace

// Layouts of what is flat already are the plane itself, turned and scaled: a carried point keeps its place,
// whichever of the two steps it takes, from shared triangles too. (Where the collapse folds nothing, that is:
// whoever collapses edges has seen to it.)
TEST_CASE("flattening: in a flat neighbourhood no point moves") {
    int carried = 0, shared = 0, on_border = 0;
    for_each_edge(0, [&](const Sample& sample, Id i, Id j, std::mt19937& random) {
        if (forbidden(i, j)) return;
        const bool inside = !border(i) && !border(j);
        const double across = inside ? std::uniform_real_distribution<double>(-0.2, 0.2)(random) : 0;
        const Collapse collapse(sample, i, j, random_along(i, j, random), across);
        if (!collapse.done || collapse.least_area() <= 0) return;
        for (int s = 0; s < 2; ++s)
            for (int k = 0; k < collapse.faces(s); ++k) {
                const StarPoint from{s, {k, random_weights(random)}};
                if (!collapse.moves(from)) continue;
                const StarPoint to = collapse.flat.carry(from);
                CHECK((collapse.after(to) - collapse.before(from)).norm() < 1e-4);
                ++carried;
                shared += collapse.flat.is_shared(s, k);
                on_border += !inside;
            }
    });
    CHECK(carried > 10000);
    CHECK(shared > 2000);
    CHECK(on_border > 2000);
}

// With features angles no longer sum to a full turn, and points move; but never off the mesh.
TEST_CASE("flattening: carried points lie in surviving triangles, weights in the simplex") {
    int carried = 0;
    for (const float features : {0.0f, 0.5f, 3.0f})
        for_each_edge(features, [&](const Sample& sample, Id i, Id j, std::mt19937& random) {
            if (forbidden(i, j)) return;
            const Collapse collapse(sample, i, j, random_along(i, j, random), 0);
            if (!collapse.done) return;
            for (int s = 0; s < 2; ++s)
                for (int k = 0; k < collapse.faces(s); ++k) {
                    const StarPoint from{s, {k, random_weights(random)}};
                    if (!collapse.moves(from)) continue;
                    const StarPoint to = collapse.flat.carry(from);
                    REQUIRE(to.at.triangle >= 0);
                    REQUIRE(to.at.triangle < collapse.faces(to.star));
                    CHECK(!collapse.flat.is_shared(to.star, to.at.triangle));
                    const auto& w = to.at.weight;
                    CHECK(*std::min_element(w.begin(), w.end()) >= 0);
                    CHECK(w[0] + w[1] + w[2] == doctest::Approx(1).epsilon(1e-12));
                    ++carried;
                }
        });
    CHECK(carried > 30000);
}

// The parameterization is continuous: a point of the edge between two triangles is carried to one place,
// whichever of them it is said to lie in. That holds across the rim of the shared triangles as well.
TEST_CASE("flattening: triangles that share an edge carry its points alike") {
    int compared = 0;
    for_each_edge(1, [&](const Sample& sample, Id i, Id j, std::mt19937& random) {
        if (forbidden(i, j)) return;
        const Collapse collapse(sample, i, j, random_along(i, j, random), 0);
        if (!collapse.done) return;
        for (int s = 0; s < 2; ++s) {
            const int faces = collapse.faces(s);
            for (int k = collapse.stars[index(s)].closed ? 0 : 1; k < faces; ++k) {
                const double t = std::uniform_real_distribution<double>(0.05, 0.95)(random);
                const StarPoint first{s, {(k + faces - 1) % faces, {1 - t, 0, t}}};
                const StarPoint second{s, {k, {1 - t, t, 0}}};
                if (!collapse.moves(first) || !collapse.moves(second)) continue;
                const Vec2d a = collapse.after(collapse.flat.carry(first)),
                            b = collapse.after(collapse.flat.carry(second));
                CHECK((a - b).norm() < 1e-6);
                ++compared;
            }
        }
    });
    CHECK(compared > 10000);
}

// In the plane a collapse folds nothing exactly if every triangle that survives keeps its orientation, and
// with the merged vertex among the shared triangles that is all that can go wrong.
TEST_CASE("flattening: a collapse is refused where a triangle would turn over or lose its area") {
    int allowed = 0, refused = 0;
    for_each_edge(0, [&](const Sample& sample, Id i, Id j, std::mt19937& random) {
        if (border(i) || border(j)) return;
        const double along = std::uniform_real_distribution<double>(0.05, 0.95)(random);
        const Collapse between(sample, i, j, along, 0);
        if (std::abs(between.least_area()) > 1e-3) {
            CHECK(between.done == (between.least_area() > 0));
            ++(between.done ? allowed : refused);
        }
    });
    CHECK(allowed > 500);
    CHECK(refused > 20);
}

// There is no direction from a center to a point that coincides with it, in the features too: no layout.
TEST_CASE("flattening: a collapse is refused where a ring vertex falls onto its center") {
    std::mt19937 random(3);
    for (int repeat = 0; repeat < 20; ++repeat) {
        const Id i = 2 * kSide + 2, j = 2 * kSide + 3, beside = 2 * kSide + 1;
        Sample sample(1, random);
        const auto from = sample.points.begin() + i * kDimensions;
        const auto to = sample.points.begin() + beside * kDimensions;
        std::copy_n(from, 2, to);
        CHECK(Collapse(sample, i, j, 0.5, 0).done);  // their features tell them apart
        std::copy_n(from, kDimensions, to);
        CHECK(!Collapse(sample, i, j, 0.5, 0).done);
    }
}
