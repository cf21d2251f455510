#include <doctest/doctest.h>

#include <Eigen/Dense>
#include <random>

#include "libcore/simplify/quadrics/matrix_quadric.h"
#include "libcore/simplify/quadrics/vertex_quadrics.h"
#include "tests/support/grid_faces.h"
#include "tests/support/sample_pictures.h"

using namespace imgmesh;
using namespace imgmesh::test;

namespace {

constexpr float kLambda = 2.5f;
constexpr Metric kMetrics[] = {Metric::kFlattened, Metric::kHoppe, Metric::kGarland};
constexpr Solver kSolvers[] = {Solver::kClosed, Solver::kSvd, Solver::kLu};

using Point = Eigen::Matrix<double, 5, 1>;

SimplifyParams params_of(Metric metric, Solver solver = Solver::kClosed) {
    return {.metric = metric, .solver = solver, .geometry_weight = kLambda};
}

std::vector<MatrixQuadric<3>> quadrics_of(const GridMesh& grid, const SimplifyParams& params) {
    return matrix_quadrics<3>(grid, ring_mesh(grid), FeaturePatch{grid.feature}, params);
}

Vec3f features_of(const MatrixQuadric<3>& quadric, float x, float y) {
    Vec3f out;
    quadric.features(x, y, out.data());
    return out;
}

// The definitions, face by face, each written as a distance and not as a matrix.
double error_of(const GridMesh& grid, Metric metric, Id vertex, const Point& v) {
    const auto w = static_cast<Id>(grid.feature.width);
    const auto corner = [&](Id n) {
        Point p;
        p << double(n % w), double(n / w), Eigen::Map<const Vec3f>(grid.feature.pixel(n)).cast<double>();
        return p;
    };
    double sum = 0;
    for (const Face& f : grid_faces(grid)) {
        if (std::find(f.begin(), f.end(), vertex) == f.end()) continue;
        const Point a = corner(f[0]), b = corner(f[1]), c = corner(f[2]);
        const double area = 0.5;
        if (metric == Metric::kGarland) {
            // What Gram and Schmidt leave of the way to the face, with positions in units of colour.
            Eigen::Matrix<double, 5, 1> scale;
            scale << std::sqrt(double{kLambda}), std::sqrt(double{kLambda}), 1, 1, 1;
            const Point e1 = scale.cwiseProduct(b - a).normalized();
            const Point raw = scale.cwiseProduct(c - a), e2 = (raw - e1.dot(raw) * e1).normalized();
            const Point way = scale.cwiseProduct(v - a);
            sum += area * (way - e1.dot(way) * e1 - e2.dot(way) * e2).squaredNorm();
            continue;
        }
        // The face's colours at v's position, by barycentric coordinates.
        Eigen::Matrix3d corners;
        corners << a[0], b[0], c[0], a[1], b[1], c[1], 1, 1, 1;
        const Vec3d weights = corners.inverse() * Vec3d(v[0], v[1], 1);
        const Vec3d color = weights[0] * a.tail<3>() + weights[1] * b.tail<3>() + weights[2] * c.tail<3>();
        sum += area * (v.tail<3>() - color).squaredNorm();
        if (metric == Metric::kFlattened)
            sum += area * double{kLambda} * (v - (a + b + c) / 3).head<2>().squaredNorm();
    }
    return sum;
}

Point random_point(std::mt19937& random, const Point& about, double radius) {
    std::uniform_real_distribution<double> uniform(-radius, radius);
    Point p = about;
    for (int k = 0; k < 5; ++k) p[k] += (k < 2 ? 1 : 10) * uniform(random);
    return p;
}

}  // namespace

TEST_CASE("matrix quadrics: equal to the distances that each metric is made of, single and summed") {
    std::mt19937 random(1);
    for (const Metric metric : kMetrics)
        for (const Kind kind : kAllKinds) {
            INFO(metric_name(metric) << ", " << name_of(kind));
            const GridMesh grid = grid_mesh(sample_feature(kind, 7, 6));
            const auto quadrics = quadrics_of(grid, params_of(metric));
            for (const std::size_t count : {1u, 2u, 20u}) {
                std::vector<Id> ids(count);
                for (Id& id : ids) id = static_cast<Id>(random() % quadrics.size());
                MatrixQuadric<3> sum = quadrics[ids[0]];
                for (std::size_t k = 1; k < count; ++k) sum = merged(sum, quadrics[ids[k]]);
                for (int n = 0; n < 20; ++n) {
                    const Point at = random_point(random, sum.origin, n % 2 ? 0.2 : 5.0);
                    double expected = 0;
                    for (const Id id : ids) expected += error_of(grid, metric, id, at);
                    CHECK(sum.value(at - sum.origin) == doctest::Approx(expected).epsilon(1e-7));
                }
            }
        }
}

TEST_CASE("matrix quadrics: the flattened one is the canonical one") {
    std::mt19937 random(2);
    for (const Kind kind : kAllKinds)
        for (const Solver solver : kSolvers) {
            INFO(name_of(kind) << ", " << solver_name(solver));
            const GridMesh grid = grid_mesh(sample_feature(kind, 8, 8));
            const FeaturePatch smooth{smoothed(grid.feature, 1)};
            const auto canonical = vertex_quadrics<3>(grid, smooth, kLambda);
            const auto dense =
                matrix_quadrics<3>(grid, ring_mesh(grid), smooth, params_of(Metric::kFlattened, solver));
            for (int trial = 0; trial < 30; ++trial) {
                const Id a = static_cast<Id>(random() % 64), b = static_cast<Id>(random() % 64);
                const Quadric<3> q = merged(canonical[a], canonical[b]);
                const MatrixQuadric<3> d = merged(dense[a], dense[b]);
                CHECK(d.unique);
                CHECK(double(d.px) == doctest::Approx(double(q.px)).epsilon(1e-3));
                CHECK(double(d.py) == doctest::Approx(double(q.py)).epsilon(1e-3));
                CHECK(double(d.error) == doctest::Approx(double(q.error)).epsilon(1e-3));
                const float x = q.px + 0.75f, y = q.py - 1.5f;
                CHECK(double(d.at(x, y)) == doctest::Approx(double(q.at(x, y))).epsilon(1e-3));
                CHECK(double(d.best_x(y)) == doctest::Approx(double(q.best_x(y))).epsilon(1e-3));
                CHECK(double(d.best_y(x)) == doctest::Approx(double(q.best_y(x))).epsilon(1e-3));
                for (int c = 0; c < 3; ++c)
                    CHECK(std::abs(features_of(d, x, y)[c] - q.feature(c, x, y)) < 0.02f);
            }
        }
}

TEST_CASE("matrix quadrics: all solvers find the least point, and its value is the error") {
    std::mt19937 random(3);
    for (const Metric metric : kMetrics)
        for (const Solver solver : kSolvers) {
            INFO(metric_name(metric) << ", " << solver_name(solver));
            const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 8, 8));
            const auto quadrics = quadrics_of(grid, params_of(metric, solver));
            for (int trial = 0; trial < 30; ++trial) {
                const Id a = static_cast<Id>(random() % 64), b = static_cast<Id>(random() % 64);
                const MatrixQuadric<3> q = merged(quadrics[a], quadrics[b]);
                REQUIRE(q.unique);
                Point least;
                least << q.px, q.py, features_of(q, q.px, q.py).cast<double>();
                CHECK(double(q.error) == doctest::Approx(q.value(least - q.origin)).epsilon(1e-4));
                CHECK(double(q.at(q.px, q.py)) == doctest::Approx(double(q.error)).epsilon(1e-4));
                for (const double radius : {0.01, 0.1, 1.0})
                    CHECK(q.value(random_point(random, least, radius) - q.origin) >=
                          double(q.error) * (1 - 1e-5));
                // On a line the best is the least too.
                for (const float step : {-0.5f, 0.5f}) {
                    const float x = q.px + step, y = q.py + step;
                    CHECK(q.at(x, q.best_y(x)) <= q.at(x, q.best_y(x) + step));
                    CHECK(q.at(q.best_x(y), y) <= q.at(q.best_x(y) + step, y));
                }
            }
        }
}

// Where colours are linear every position along the plane is as good for all metrics but the paper's: the
// singular case, in which every solver has to notice it, and still to find the least value, which is zero.
TEST_CASE("matrix quadrics: on a linear image only the flattened metric has a minimiser") {
    FeatureImage feature{6, 6, 3, {}};
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x)
            for (const float color :
                 {50 + 3.0f * static_cast<float>(x), 2.0f * static_cast<float>(y), static_cast<float>(x - y)})
                feature.data.push_back(color);
    const GridMesh grid = grid_mesh(feature);
    for (const Metric metric : kMetrics)
        for (const Solver solver : kSolvers) {
            INFO(metric_name(metric) << ", " << solver_name(solver));
            const auto quadrics = quadrics_of(grid, params_of(metric, solver));
            const MatrixQuadric<3> q = merged(merged(quadrics[7], quadrics[8]), quadrics[20]);
            CHECK(q.unique == (metric == Metric::kFlattened));
            CHECK(q.has_minimum(kFixedX) == (metric == Metric::kFlattened));
            if (metric == Metric::kFlattened) continue;
            CHECK(q.error < 1e-6f);
            CHECK(q.at(3.25f, 2.0f) < 1e-6f);
            CHECK(double(features_of(q, 3.25f, 2.0f)[0]) == doctest::Approx(59.75));
        }
}

// An image that changes along x alone: along y all is free, so only x is to be found.
TEST_CASE("matrix quadrics: a step that is the same all along has a best place across only") {
    FeatureImage feature{6, 6, 3, {}};
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x) feature.data.insert(feature.data.end(), {x < 3 ? 0.f : 60.f, 0, 0});
    const GridMesh grid = grid_mesh(feature);
    for (const Solver solver : kSolvers) {
        INFO(solver_name(solver));
        const auto quadrics = quadrics_of(grid, params_of(Metric::kHoppe, solver));
        const MatrixQuadric<3> q = merged(quadrics[2 * 6 + 2], quadrics[3 * 6 + 2]);
        CHECK_FALSE(q.unique);
        CHECK_FALSE(q.has_minimum(kFixedX));  // y would be free
        CHECK(q.has_minimum(kFixedY));
        // The flat side's planes and the slope's agree at the slope's foot, where the two vertices are.
        CHECK(double(q.best_x(2.5f)) == doctest::Approx(2));
        CHECK(q.at(2, 2.5f) < 1e-6f);
        CHECK(q.at(3, 2.5f) > 100);
    }
}

// Features of value zero change no error, so five channels, of which two are zero, must have the minimum of
// three: the path of any size against the one compiled for five dimensions. The summed quadric is taken anew
// from the mesh as well.
TEST_CASE("matrix quadrics: with any number of channels what three have") {
    const GridMesh grid = grid_mesh(sample_feature(Kind::kNoise, 5, 5));
    GridMesh wide = grid;
    wide.feature = {5, 5, 5, std::vector<float>(25 * 5, 0.0f)};
    for (std::size_t v = 0; v < 25; ++v)
        std::copy_n(grid.feature.pixel(v), 3, wide.feature.data.data() + v * 5);
    const RingMesh rings = ring_mesh(grid);
    const auto same = [](const auto& three, const auto& any) {
        const auto q = merged(three[6], three[12]);
        const auto p = merged(any[6], any[12]);
        CHECK(double(p.px) == doctest::Approx(double(q.px)).epsilon(1e-5));
        CHECK(double(p.py) == doctest::Approx(double(q.py)).epsilon(1e-5));
        CHECK(double(p.error) == doctest::Approx(double(q.error)).epsilon(1e-5));
        CHECK(double(p.at(2, 3)) == doctest::Approx(double(q.at(2, 3))).epsilon(1e-5));
        CHECK(double(p.best_x(2)) == doctest::Approx(double(q.best_x(2))).epsilon(1e-5));
        CHECK(p.unique == q.unique);
        CHECK(p.channels() == 5);
        float features[5];
        p.features(2, 2, features);
        for (int c = 0; c < 3; ++c)
            CHECK(double(features[c]) == doctest::Approx(double(features_of(q, 2, 2)[c])).epsilon(1e-5));
        CHECK(features[3] == 0);
        CHECK(features[4] == 0);
    };
    for (const Metric metric : kMetrics)
        for (const Solver solver : kSolvers) {
            INFO(metric_name(metric) << ", " << solver_name(solver));
            const SimplifyParams params = params_of(metric, solver);
            const auto three = matrix_quadrics<3>(grid, rings, FeaturePatch{grid.feature}, params);
            const auto any = matrix_quadrics<kAnyChannels>(wide, rings, FeaturePatch{wide.feature}, params);
            same(three, any);
            same(matrix_quadrics(rings, three, params), matrix_quadrics(rings, any, params));
        }
}
