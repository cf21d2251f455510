// The flattening of rings, and the lookup in flat fans.
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "libcore/param/conformal.h"

using namespace imgmesh;

namespace {

constexpr int kDimensions = 5;
using Point = std::array<float, kDimensions>;

struct Neighbourhood {
    Point pivot;
    std::vector<Point> ring;

    bool flatten(bool open, FlatRing& flat) const {
        std::vector<const float*> points;
        for (const Point& p : ring) points.push_back(p.data());
        return flatten_ring(pivot.data(), points, kDimensions, open, flat);
    }
};

// Around a random pivot, in the plane of two orthogonal directions of five-dimensional space: as an open ring
// half a disc, its ends on a line through the pivot.
Neighbourhood flat_neighbourhood(int size, bool open, std::mt19937& random, std::vector<Vec2d>& places) {
    const auto uniform = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    Neighbourhood n;
    for (float& x : n.pivot) x = static_cast<float>(uniform(-50, 50));
    // The second direction is orthogonal to the first, and both have length 1.
    const std::array<double, 5> first{0.6, 0, 0.48, 0, 0.64}, second{0, 0.28, 0, 0.96, 0};
    const double turn = open ? std::numbers::pi / (size - 1) : 2 * std::numbers::pi / size;
    for (int k = 0; k < size; ++k) {
        const bool end = open && (k == 0 || k + 1 == size);
        const double angle = turn * (k + (end ? 0 : uniform(-0.3, 0.3))), radius = uniform(0.5, 20);
        places.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
        Point p{};
        for (std::size_t c = 0; c < 5; ++c)
            p[c] =
                n.pivot[c] + static_cast<float>(places.back().x() * first[c] + places.back().y() * second[c]);
        n.ring.push_back(p);
    }
    return n;
}

Neighbourhood random_neighbourhood(int size, std::mt19937& random) {
    Neighbourhood n;
    const auto fill = [&](Point& p) {
        for (float& x : p) x = std::uniform_real_distribution<float>(-10, 10)(random);
    };
    fill(n.pivot);
    n.ring.resize(static_cast<std::size_t>(size));
    for (Point& p : n.ring) fill(p);
    return n;
}

double angle(const Point& pivot, const Point& a, const Point& b) {
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t c = 0; c < 5; ++c) {
        const double d = double(a[c]) - double(pivot[c]), e = double(b[c]) - double(pivot[c]);
        ab += d * e;
        aa += d * d;
        bb += e * e;
    }
    return std::acos(ab / std::sqrt(aa * bb));
}

}  // namespace

// A flat ring keeps its shape: the layout is the ring turned and scaled.
TEST_CASE("conformal: the map of a flat neighbourhood is the identity up to a similarity") {
    std::mt19937 random(1);
    for (const bool open : {false, true})
        for (int size = 3; size <= 12; ++size)
            for (int repeat = 0; repeat < 20; ++repeat) {
                INFO(size << (open ? " open" : " closed"));
                std::vector<Vec2d> places;
                const Neighbourhood n = flat_neighbourhood(size, open, random, places);
                FlatRing flat;
                REQUIRE(n.flatten(open, flat));
                CHECK(flat.exponent == doctest::Approx(1).epsilon(1e-4));
                // As complex numbers, one factor takes all places to the layout.
                const Vec2d &from = places[0], &to = flat.at[0];
                const double re = from.dot(to) / from.squaredNorm(),
                             im = (from.x() * to.y() - from.y() * to.x()) / from.squaredNorm();
                for (std::size_t k = 0; k < places.size(); ++k) {
                    const Vec2d& p = places[k];
                    const Vec2d expected(re * p.x() - im * p.y(), re * p.y() + im * p.x());
                    CHECK((flat.at[k] - expected).norm() < 2e-4 * (1 + expected.norm()));
                }
            }
}

TEST_CASE("conformal: angles keep their shares of the full angle, which is 2 pi, on a border pi") {
    std::mt19937 random(2);
    for (const bool open : {false, true})
        for (int size = 3; size <= 12; ++size)
            for (int repeat = 0; repeat < 20; ++repeat) {
                INFO(size << (open ? " open" : " closed"));
                const Neighbourhood n = random_neighbourhood(size, random);
                FlatRing flat;
                REQUIRE(n.flatten(open, flat));
                double total = 0;
                std::vector<double> angles;
                for (std::size_t k = 0; k + (open ? 1 : 0) < n.ring.size(); ++k) {
                    angles.push_back(angle(n.pivot, n.ring[k], n.ring[(k + 1) % n.ring.size()]));
                    total += angles.back();
                }
                const double full = open ? std::numbers::pi : 2 * std::numbers::pi;
                CHECK(flat.exponent == doctest::Approx(full / total));
                double sum = 0;
                for (std::size_t k = 0; k < angles.size(); ++k) {
                    const Vec2d &a = flat.at[k], &b = flat.at[(k + 1) % n.ring.size()];
                    double turn = std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
                    if (turn < -1e-9) turn += 2 * std::numbers::pi;
                    CHECK(turn == doctest::Approx(angles[k] * full / total).epsilon(1e-6));
                    sum += turn;
                }
                CHECK(sum == doctest::Approx(full));
                if (!open) continue;
                CHECK(flat.at[0].y() == 0);
                CHECK(flat.at[n.ring.size() - 1].y() == 0);
                CHECK(flat.at[n.ring.size() - 1].x() < 0);
            }
}

// r^alpha: twice the distance is 2^alpha times as far.
TEST_CASE("conformal: distances go by the power alpha") {
    std::mt19937 random(3);
    Neighbourhood n = random_neighbourhood(5, random);
    for (std::size_t c = 0; c < 5; ++c) n.ring[1][c] = 2 * n.ring[0][c] - n.pivot[c];
    FlatRing flat;
    REQUIRE(n.flatten(false, flat));
    CHECK(flat.exponent != doctest::Approx(1));
    CHECK(flat.at[1].norm() / flat.at[0].norm() ==
          doctest::Approx(std::pow(2.0, flat.exponent)).epsilon(1e-5));
}

TEST_CASE("conformal: no layout where a ring point is the pivot, or nothing turns") {
    std::mt19937 random(4);
    Neighbourhood n = random_neighbourhood(4, random);
    FlatRing flat;
    n.ring[2] = n.pivot;
    CHECK_FALSE(n.flatten(false, flat));
    for (std::size_t k = 0; k < 4; ++k)
        n.ring[k] = {n.pivot[0] + static_cast<float>(k + 1), n.pivot[1], n.pivot[2], n.pivot[3], n.pivot[4]};
    CHECK_FALSE(n.flatten(false, flat));
}

TEST_CASE("flat fan: weights give the point back, and points outside go to the nearest triangle's edge") {
    const std::array<Vec2d, 5> ring{Vec2d(4, 0), Vec2d(1, 3), Vec2d(-2, 2), Vec2d(-3, -1), Vec2d(1, -2)};
    const Vec2d center(0.5, 0.25);
    FlatFan fan;
    REQUIRE(fan.set(center, ring, true));
    CHECK(fan.size() == 5);
    std::mt19937 random(5);
    for (int repeat = 0; repeat < 200; ++repeat) {
        std::array<double, 3> w{};
        double sum = 0;
        for (double& x : w) sum += x = std::uniform_real_distribution<double>(0, 1)(random);
        const std::size_t k = random() % 5;
        const Vec2d p = (w[0] * center + w[1] * ring[k] + w[2] * ring[(k + 1) % 5]) / sum;
        const FanPoint found = fan.locate(p);
        const auto t = static_cast<std::size_t>(found.triangle);
        CHECK(t == k);
        const Vec2d back =
            found.weight[0] * center + found.weight[1] * ring[t] + found.weight[2] * ring[(t + 1) % 5];
        CHECK((back - p).norm() < 1e-12);
    }
    const FanPoint outside = fan.locate(Vec2d(3.5, 2.5));
    CHECK(outside.triangle == 0);
    CHECK(outside.weight[0] == 0);
    CHECK(outside.weight[1] + outside.weight[2] == doctest::Approx(1));
}

TEST_CASE("flat fan: a triangle that is flipped or has no area is refused") {
    FlatFan fan;
    const std::array<Vec2d, 3> flipped{Vec2d(1, 0), Vec2d(1, 1), Vec2d(2, 0.5)},
        flat{Vec2d(1, 0), Vec2d(1, 1), Vec2d(2, 2)};
    CHECK_FALSE(fan.set(Vec2d::Zero(), flipped, false));
    CHECK_FALSE(fan.set(Vec2d::Zero(), flat, false));
    CHECK(fan.set(Vec2d::Zero(), std::span(flat).first(2), false));
}
