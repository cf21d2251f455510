#include <doctest/doctest.h>

#include <cmath>

#include <Eigen/LU>
#include <random>

#include "libcore/simplify/kernel/merge_increments.h"
#include "libcore/simplify/kernel/shape_limits.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"
#include "tests/support/grid_faces.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr float kLambda = 3;

// The sum that a vertex's quadric represents, term by term in double: over its faces, area times (lambda
// times the squared distance to the centroid, plus the squared distance to the plane through the vertex's own
// colour with the face's gradient).
struct BruteForce {
    struct Term {
        double area;
        Vec2d centroid, corner;
        Vec3d color;
        Eigen::Matrix<double, 3, 2> gradient;
    };
    std::vector<Term> terms;

    double at(const Vec2d& p, const Vec3d& s) const {
        double sum = 0;
        for (const Term& t : terms)
            sum += t.area * (kLambda * (p - t.centroid).squaredNorm() +
                             (s - t.color - t.gradient * (p - t.corner)).squaredNorm());
        return sum;
    }
};

void add_vertex(const GridMesh& grid, const FeatureImage& gradients, Id vertex, BruteForce& out) {
    const auto w = static_cast<Id>(grid.feature.width);
    const auto position = [&](Id v) {
        return Vec2d(double(grid.origin_x) + v % w, double(grid.origin_y) + v / w);
    };
    const auto color = [](const FeatureImage& image, Id v) {
        return Eigen::Map<const Vec3f>(image.pixel(v)).cast<double>();
    };
    for (const Face& f : grid_faces(grid)) {
        if (std::find(f.begin(), f.end(), vertex) == f.end()) continue;
        Eigen::Matrix2d edges;
        edges << position(f[1]) - position(f[0]), position(f[2]) - position(f[0]);
        Eigen::Matrix<double, 3, 2> rise;
        rise << color(gradients, f[1]) - color(gradients, f[0]),
            color(gradients, f[2]) - color(gradients, f[0]);
        const Vec2d centroid = (position(f[0]) + position(f[1]) + position(f[2])) / 3;
        out.terms.push_back({std::abs(edges.determinant()) / 2, centroid, position(vertex),
                             color(grid.feature, vertex), rise * edges.inverse()});
    }
}

struct Point {
    Vec2d p;
    Vec3d s;
};
Point random_point(std::mt19937& random, const Vec2d& p, const Vec3d& s, double radius, double color_radius) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    Point out{p, s};
    for (int k = 0; k < 2; ++k) out.p[k] += radius * uniform(random);
    for (int k = 0; k < 3; ++k) out.s[k] += color_radius * uniform(random);
    return out;
}

double value(const Quadric<3>& q, const Point& at) {
    const Vec3f s = at.s.cast<float>();
    return double(q.at(static_cast<float>(at.p.x()), static_cast<float>(at.p.y()), s.data()));
}

// Two quadrics are the same function if they agree at more points than they have numbers.
void check_same_function(const Quadric<3>& q, const BruteForce& truth, std::mt19937& random) {
    for (int n = 0; n < 30; ++n) {
        Point at = random_point(random, Vec2d(q.px, q.py), Vec3d(q.s[0], q.s[1], q.s[2]), n < 10 ? 0.1 : 6,
                                n < 20 ? 1 : 60);
        at.p = at.p.cast<float>().cast<double>();
        at.s = at.s.cast<float>().cast<double>();
        const double expected = truth.at(at.p, at.s);
        CHECK(value(q, at) == doctest::Approx(expected).epsilon(5e-4));
    }
}

Quadric<3> merged_of(const std::vector<Quadric<3>>& quadrics, const std::vector<Id>& ids) {
    Quadric<3> sum = quadrics[ids[0]];
    for (std::size_t k = 1; k < ids.size(); ++k) sum = merged(sum, quadrics[ids[k]]);
    return sum;
}

}  // namespace

TEST_CASE("vertex quadrics: equal to the sum over the faces that they stand for, everywhere") {
    std::mt19937 random(1);
    for (const Kind kind : kAllKinds)
        for (const int passes : {0, 2}) {
            INFO(name_of(kind) << ", " << passes << " passes");
            const GridMesh grid = grid_mesh(sample_feature(kind, 6, 5));
            const FeatureImage gradients = smoothed(grid.feature, passes);
            const std::vector<Quadric<3>> quadrics =
                vertex_quadrics<3>(grid, FeaturePatch{gradients}, kLambda);
            for (Id v = 0; v < quadrics.size(); ++v) {
                BruteForce truth;
                add_vertex(grid, gradients, v, truth);
                check_same_function(quadrics[v], truth, random);
            }
        }
}

TEST_CASE("vertex quadrics: of a strip one pixel wide") {
    std::mt19937 random(2);
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 1, 5));
    const std::vector<Quadric<3>> quadrics = vertex_quadrics<3>(grid, FeaturePatch{grid.feature}, kLambda);
    REQUIRE(quadrics.size() == 10);
    for (Id v = 0; v < quadrics.size(); ++v) {
        BruteForce truth;
        add_vertex(grid, grid.feature, v, truth);
        check_same_function(quadrics[v], truth, random);
    }
}

// A collapse merges again and again: rounding must not accumulate.
TEST_CASE("merged: the sum of many vertices' quadrics is the sum of all of their faces") {
    std::mt19937 random(3);
    for (const Kind kind : kAllKinds) {
        INFO(name_of(kind));
        const GridMesh grid = grid_mesh(sample_feature(kind, 9, 8));
        const std::vector<Quadric<3>> quadrics =
            vertex_quadrics<3>(grid, FeaturePatch{grid.feature}, kLambda);
        for (const std::size_t count : {2u, 3u, 30u}) {
            std::vector<Id> ids(count);
            for (Id& id : ids) id = static_cast<Id>(random() % quadrics.size());
            BruteForce truth;
            for (const Id id : ids) add_vertex(grid, grid.feature, id, truth);
            check_same_function(merged_of(quadrics, ids), truth, random);
        }
    }
}

TEST_CASE("merged: no nearby point is lower than the minimiser, and its value is the error") {
    std::mt19937 random(4);
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 9, 8));
    const std::vector<Quadric<3>> quadrics = vertex_quadrics<3>(grid, FeaturePatch{grid.feature}, kLambda);
    for (int trial = 0; trial < 50; ++trial) {
        const Id i = static_cast<Id>(random() % quadrics.size()),
                 j = static_cast<Id>(random() % quadrics.size());
        BruteForce truth;
        add_vertex(grid, grid.feature, i, truth);
        add_vertex(grid, grid.feature, j, truth);
        const Quadric<3> sum = merged(quadrics[i], quadrics[j]);
        const Point least{{sum.px, sum.py}, {sum.s[0], sum.s[1], sum.s[2]}};
        const double bottom = truth.at(least.p, least.s);
        CHECK(double(sum.error) == doctest::Approx(bottom).epsilon(1e-4));
        for (const double radius : {0.003, 0.03, 0.3})
            for (int n = 0; n < 10; ++n) {
                const Point other = random_point(random, least.p, least.s, radius, 20 * radius);
                CHECK(truth.at(other.p, other.s) >= bottom * (1 - 1e-6));
            }
    }
}

TEST_CASE("merged_minimum: the increment is the least error of the sum less both least errors") {
    std::mt19937 random(5);
    for (const Kind kind : kAllKinds) {
        const GridMesh grid = grid_mesh(sample_feature(kind, 9, 8));
        const std::vector<Quadric<3>> quadrics =
            vertex_quadrics<3>(grid, FeaturePatch{grid.feature}, kLambda);
        for (int trial = 0; trial < 20; ++trial) {
            const Quadric<3>&i = quadrics[random() % quadrics.size()],
                  &j = quadrics[random() % quadrics.size()];
            const MergedMinimum<float> m = merged_minimum(i, j);
            const Quadric<3> sum = merged(i, j);
            const Point least{{sum.px, sum.py}, {sum.s[0], sum.s[1], sum.s[2]}};
            CHECK(m.increment >= 0);
            CHECK(sum.px == doctest::Approx(i.px + m.qx));
            CHECK(sum.py == doctest::Approx(i.py + m.qy));
            CHECK(value(i, least) + value(j, least) - i.error - j.error ==
                  doctest::Approx(m.increment).epsilon(1e-3).scale(i.error + j.error));
        }
    }
}

// Compared with the formula for one pair; the last pairs are singular.
TEST_CASE("star increments: those of merged_minimum, to the bit, for any number of neighbours") {
    std::mt19937 random(6);
    for (const Kind kind : kAllKinds) {
        const GridMesh grid = grid_mesh(sample_feature(kind, 9, 8));
        std::vector<Quadric<3>> quadrics =
            vertex_quadrics<3>(grid, FeaturePatch{smoothed(grid.feature, 1)}, kLambda);
        for (std::size_t k = 0; k < 20; ++k)
            quadrics[k] = merged(quadrics[k], quadrics[random() % quadrics.size()]);
        Quadric<3> singular;
        singular.weight = 1;
        quadrics.push_back(singular);
        singular.px = 4;
        singular.s[0] = 3;
        quadrics.push_back(singular);
        for (int trial = 0; trial < 50; ++trial) {
            const Id i = static_cast<Id>(random() % quadrics.size());
            const int count = static_cast<int>(random() % (kMaxValence + 1));
            Id others[kNeighborRoom];
            float expected[kNeighborRoom], increments[kNeighborRoom];
            for (int k = 0; k < count; ++k) {
                others[k] = static_cast<Id>(random() % quadrics.size());
                expected[k] = merged_minimum(quadrics[i], quadrics[others[k]]).increment;
            }
            merge_increments(quadrics.data(), i, others, count, increments);
            for (int k = 0; k < count; ++k) CHECK(increments[k] == expected[k]);
        }
    }
}

// Every rule for each triangle of a random star, written for one triangle at a time.
TEST_CASE("shape limits: no triangle of the star too thin, too large, too far from regular, or turned over") {
    std::mt19937 random(8);
    const auto number = [&] { return static_cast<float>(random() % 1000) / 100; };
    int allowed = 0;
    for (int trial = 0; trial < 4000; ++trial) {
        RingMesh rings(kMaxValence);
        MergedRing star;
        star.valence = 3 + static_cast<int>(random() % (kMaxValence - 2));
        const float turn = -6.2831853f / static_cast<float>(star.valence);  // counter-clockwise on screen
        for (Id v = 0; v < static_cast<Id>(star.valence); ++v) {
            star.neighbor[v] = v;
            const float angle = turn * (static_cast<float>(v) + 0.03f * number()), radius = 2 + number();
            rings[v].x = 10 + radius * std::cos(angle);
            rings[v].y = 10 + radius * std::sin(angle);
        }
        const bool border = random() % 4 == 0;
        const ShapeLimits limits = ShapeLimits::of(random() % 2 ? 30.0f : 1e9f, random() % 2 ? 0.4f : 0.0f);
        const float x = 8 + 0.4f * number(), y = 8 + 0.4f * number();
        bool expected = true;
        for (int k = 0; k < star.valence - border; ++k) {
            const Ring &a = rings[star.neighbor[static_cast<std::size_t>(k)]],
                       &b = rings[star.neighbor[static_cast<std::size_t>((k + 1) % star.valence)]];
            const float ax = a.x - x, ay = a.y - y, bx = b.x - x, by = b.y - y, ex = bx - ax, ey = by - ay;
            const float aa = ax * ax + ay * ay, bb = bx * bx + by * by, ee = ex * ex + ey * ey;
            const float area2 = ay * bx - ax * by;
            expected &= area2 > kFatness * std::max({aa, bb, ee}) && area2 <= limits.max_area2 &&
                        area2 >= limits.min_area2_per_sum * (aa + bb + ee);
        }
        CHECK(limits.allow(rings, star, border, x, y) == expected);
        allowed += expected;
    }
    CHECK(allowed > 400);
    CHECK(allowed < 3600);
}

// With lambda 0 and one common gradient every position along the plane is equally good: take the middle.
TEST_CASE("merged_minimum: a singular pair meets half way") {
    Quadric<3> i, j;
    i.weight = j.weight = 1;
    j.px = 4;
    j.py = 2;
    const MergedMinimum<float> m = merged_minimum(i, j);
    CHECK(m.qx == 2);
    CHECK(m.qy == 1);
    CHECK(m.increment == 0);
}

TEST_CASE("quadric: its best feature for a position is the best, and at() takes it") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 5, 5));
    const Quadric<3> q = vertex_quadrics<3>(grid, FeaturePatch{grid.feature}, kLambda)[12];
    const Point at{{2.75, 1.5},
                   {q.feature(0, 2.75f, 1.5f), q.feature(1, 2.75f, 1.5f), q.feature(2, 2.75f, 1.5f)}};
    CHECK(value(q, at) == doctest::Approx(double(q.at(2.75f, 1.5f))));
    for (int c = 0; c < 3; ++c)
        for (const double step : {-0.5, 0.5}) {
            Point other = at;
            other.s[c] += step;
            CHECK(value(q, other) > value(q, at));
        }
}
