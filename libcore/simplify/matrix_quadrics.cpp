#include <Eigen/LU>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/simplify/matrix_quadric.h"

namespace imgmesh {
namespace {

// Sums the quadrics of the faces around a vertex, which is the origin.
template <int C>
class FaceSum {
  public:
    using Gradient = Eigen::Matrix<double, C, 2>;
    using Features = Eigen::Matrix<double, C, 1>;

    FaceSum(Metric metric, double lambda) : metric_(metric), lambda_(lambda) {}

    // A face: corners at 0, p and q, features less those of the vertex there dp and dq.
    void add(const Vec2d& p, const Features& dp, const Vec2d& q, const Features& dq) {
        Eigen::Matrix2d edges;
        edges << p, q;
        Gradient rise;
        rise << dp, dq;
        const double area = 0.5 * std::abs(edges.determinant());
        const Gradient g = rise * edges.inverse();
        if (metric_ == Metric::kGarland) return add_plane(area, g);
        auto& a = sum_.a;
        a.template topLeftCorner<2, 2>() += area * g.transpose() * g;
        a.template bottomLeftCorner<C, 2>() -= area * g;
        a.template topRightCorner<2, C>() -= area * g.transpose();
        a.template bottomRightCorner<C, C>().diagonal().array() += area;
        if (metric_ == Metric::kHoppe) return;
        const Vec2d centroid = (p + q) / 3;
        a.template topLeftCorner<2, 2>().diagonal().array() += area * lambda_;
        sum_.b.template head<2>() -= area * lambda_ * centroid;
        sum_.c += area * lambda_ * centroid.squaredNorm();
    }

    MatrixQuadric<C> finish(const Ring& ring, const Features& features, Solver solver) {
        sum_.origin << ring.x, ring.y, features;
        sum_.solver = solver;
        sum_.find_minimum();
        return sum_;
    }

  private:
    // Squared distance to the plane spanned by the face, positions scaled by sqrt(lambda): with tangents T,
    // w'w - w'T (T'T)^-1 T'w.
    void add_plane(double area, const Gradient& g) {
        constexpr int N = 2 + C;
        const double scale = std::sqrt(lambda_);
        Eigen::Matrix<double, N, 2> tangents;
        tangents << scale * Eigen::Matrix2d::Identity(), g;
        typename MatrixQuadric<C>::Matrix a = MatrixQuadric<C>::Matrix::Identity();
        a -= tangents * (tangents.transpose() * tangents).inverse() * tangents.transpose();
        a.template topRows<2>() *= scale;
        a.template leftCols<2>() *= scale;
        sum_.a += area * a;
    }

    Metric metric_;
    double lambda_;
    MatrixQuadric<C> sum_;
};

// One quadric a vertex. own(v): its features; slope_feature(v): the features that gradients are taken from.
template <int C, class Own, class Slope>
std::vector<MatrixQuadric<C>> quadrics_of(const RingMesh& rings, const SimplifyParams& params, const Own& own,
                                          const Slope& slope_feature) {
    using Features = typename FaceSum<C>::Features;
    std::vector<MatrixQuadric<C>> quadrics(rings.size());
    parallel_blocks(0, static_cast<int>(rings.size()), 1 << 12, [&](int first, int last) {
        for (Id v = static_cast<Id>(first); v < static_cast<Id>(last); ++v) {
            const Ring& ring = rings[v];
            if (!ring.live()) continue;
            FaceSum<C> sum(params.metric, double{params.geometry_weight});
            const Features here = slope_feature(v);
            const auto offset = [&](Id n) {
                return Vec2d(double{rings[n].x} - ring.x, double{rings[n].y} - ring.y);
            };
            for (int k = 0; k < ring.valence - (ring.border() ? 1 : 0); ++k) {
                const Id m = ring.neighbor[k], n = ring.neighbor[k + 1 == ring.valence ? 0 : k + 1];
                sum.add(offset(m), slope_feature(m) - here, offset(n), slope_feature(n) - here);
            }
            quadrics[v] = sum.finish(ring, own(v), params.solver);
        }
    });
    return quadrics;
}

template <int C>
Eigen::Matrix<double, C, 1> features_at(const float* pixel) {
    return Eigen::Map<const Eigen::Matrix<float, C, 1>>(pixel).template cast<double>();
}

}  // namespace

template <int C>
std::vector<MatrixQuadric<C>> matrix_quadrics(const GridMesh& grid, const RingMesh& rings,
                                              const FeaturePatch& gradients, const SimplifyParams& params) {
    const Id w = static_cast<Id>(grid.feature.width);
    return quadrics_of<C>(
        rings, params, [&](Id v) { return features_at<C>(grid.feature.pixel(v)); },
        [&](Id v) {
            const Id pixel = grid.pixel_of(v);
            return features_at<C>(gradients.pixel(static_cast<int>(pixel % w), static_cast<int>(pixel / w)));
        });
}

template <int C>
std::vector<MatrixQuadric<C>> matrix_quadrics(const RingMesh& rings,
                                              const std::vector<MatrixQuadric<C>>& before,
                                              const SimplifyParams& params) {
    std::vector<Eigen::Matrix<double, C, 1>> features(rings.size());
    for (Id v = 0; v < rings.size(); ++v)
        if (rings[v].live())
            for (int c = 0; c < C; ++c) features[v][c] = before[v].feature(c, rings[v].x, rings[v].y);
    const auto feature = [&](Id v) { return features[v]; };
    return quadrics_of<C>(rings, params, feature, feature);
}

template std::vector<MatrixQuadric<3>> matrix_quadrics(const GridMesh&, const RingMesh&, const FeaturePatch&,
                                                       const SimplifyParams&);
template std::vector<MatrixQuadric<8>> matrix_quadrics(const GridMesh&, const RingMesh&, const FeaturePatch&,
                                                       const SimplifyParams&);
template std::vector<MatrixQuadric<16>> matrix_quadrics(const GridMesh&, const RingMesh&, const FeaturePatch&,
                                                        const SimplifyParams&);
template std::vector<MatrixQuadric<3>> matrix_quadrics(const RingMesh&, const std::vector<MatrixQuadric<3>>&,
                                                       const SimplifyParams&);
template std::vector<MatrixQuadric<8>> matrix_quadrics(const RingMesh&, const std::vector<MatrixQuadric<8>>&,
                                                       const SimplifyParams&);
template std::vector<MatrixQuadric<16>> matrix_quadrics(const RingMesh&,
                                                        const std::vector<MatrixQuadric<16>>&,
                                                        const SimplifyParams&);

}  // namespace imgmesh
