// Steps: (1) the face quadrics around each vertex are summed, about the vertex; (2) the sum's minimum is
// found. Sources: paper sec. 3.2; Hoppe 1999; Garland and Heckbert 1998;
// docs/decisions/0006-metrics-and-solvers.md.
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>

#include "libcore/base/parallel.h"
#include "libcore/image/channel_count.h"
#include "libcore/simplify/quadrics/matrix_quadric.h"

namespace imgmesh {
namespace {

// Sums the quadrics of the faces around a vertex, which is the origin. Written coefficient by coefficient:
// Eigen's expressions of blocks, for two sizes, took six times as long to compile.
template <int C>
class FaceSum {
  public:
    FaceSum(Metric metric, double lambda, Eigen::Index channels)
        : metric_(metric), lambda_(lambda), channels_(channels), sum_(2 + channels) {}

    // A face: corners at 0, p and q, their features `own`, `of_p` and `of_q`.
    void add(const float* own, const Vec2d& p, const float* of_p, const Vec2d& q, const float* of_q) {
        Eigen::Matrix2d edges;
        edges << p, q;
        const double area = 0.5 * std::abs(edges.determinant());
        const Eigen::Matrix2d inverse = edges.inverse();
        Gradients gradients;
        for (Eigen::Index c = 0; c < channels_; ++c) {
            const double dp = double{of_p[c]} - own[c], dq = double{of_q[c]} - own[c];
            gradients[static_cast<std::size_t>(c)] = {dp * inverse(0, 0) + dq * inverse(1, 0),
                                                      dp * inverse(0, 1) + dq * inverse(1, 1)};
        }
        if (metric_ == Metric::kGarland) return add_plane(area, gradients);
        add_slopes(area, gradients);
        if (metric_ == Metric::kFlattened) add_centroid(area, (p + q) / 3);
    }

    MatrixQuadric<C> finish(const Ring& ring, const float* features, Solver solver) {
        sum_.origin[0] = double{ring.x};
        sum_.origin[1] = double{ring.y};
        for (Eigen::Index c = 0; c < channels_; ++c) sum_.origin[2 + c] = double{features[c]};
        sum_.solver = solver;
        sum_.find_minimum();
        return sum_;
    }

  private:
    using Gradients = std::array<Vec2d, kMaxFeatures>;  // of each feature

    // Squared distance to the features that the face has at a position.
    void add_slopes(double area, const Gradients& gradients) {
        auto& a = sum_.a;
        Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
        for (Eigen::Index c = 0; c < channels_; ++c) {
            const Vec2d& g = gradients[static_cast<std::size_t>(c)];
            squares += area * g * g.transpose();
            for (const int axis : {0, 1}) {
                a(2 + c, axis) -= area * g[axis];
                a(axis, 2 + c) -= area * g[axis];
            }
            a(2 + c, 2 + c) += area;
        }
        for (const int row : {0, 1})
            for (const int column : {0, 1}) a(row, column) += squares(row, column);
    }

    // Squared distance to the face's centroid, times lambda.
    void add_centroid(double area, const Vec2d& centroid) {
        for (const int axis : {0, 1}) {
            sum_.a(axis, axis) += area * lambda_;
            sum_.b[axis] -= area * lambda_ * centroid[axis];
        }
        sum_.c += area * lambda_ * centroid.squaredNorm();
    }

    // Squared distance to the plane spanned by the face, positions scaled by sqrt(lambda): with tangents T,
    // w'w - w'T (T'T)^-1 T'w.
    void add_plane(double area, const Gradients& gradients) {
        const double scale = std::sqrt(lambda_);
        std::array<Vec2d, 2 + kMaxFeatures> tangents = {Vec2d(scale, 0), Vec2d(0, scale)};
        std::copy_n(gradients.begin(), channels_, tangents.begin() + 2);
        const std::span<const Vec2d> rows(tangents.data(), static_cast<std::size_t>(2 + channels_));
        Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
        for (const Vec2d& t : rows) squares += t * t.transpose();
        const Eigen::Matrix2d inverse = squares.inverse();
        for (std::size_t k = 0; k < rows.size(); ++k) {
            const Vec2d along = inverse * rows[k];
            for (std::size_t l = 0; l < rows.size(); ++l) {
                const double off = (k == l ? 1 : 0) - along.dot(rows[l]);
                sum_.a(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(l)) +=
                    area * off * (k < 2 ? scale : 1) * (l < 2 ? scale : 1);
            }
        }
    }

    Metric metric_;
    double lambda_;
    Eigen::Index channels_;
    MatrixQuadric<C> sum_;
};

using FeaturesOf = std::function<const float*(Id vertex)>;

// One quadric a vertex. own(v): its features; slope(v): the features that gradients are taken from.
template <int C>
std::vector<MatrixQuadric<C>> quadrics_of(const RingMesh& rings, Eigen::Index channels,
                                          const SimplifyParams& params, const FeaturesOf& own,
                                          const FeaturesOf& slope) {
    std::vector<MatrixQuadric<C>> quadrics(rings.size());
    constexpr int kVertices = 1 << 12;  // that a thread takes at a time; results do not depend on it
    parallel_blocks(0, static_cast<int>(rings.size()), kVertices, [&](int first, int last) {
        for (Id v = static_cast<Id>(first); v < static_cast<Id>(last); ++v) {
            const Ring& ring = rings[v];
            if (!ring.live()) continue;
            FaceSum<C> sum(params.metric, double{params.geometry_weight}, channels);
            const auto offset = [&](Id n) {
                return Vec2d(double{rings[n].x} - ring.x, double{rings[n].y} - ring.y);
            };
            for (int k = 0; k < ring.valence - (ring.border() ? 1 : 0); ++k) {
                const Id m = ring.neighbor[k], n = ring.neighbor[k + 1 == ring.valence ? 0 : k + 1];
                sum.add(slope(v), offset(m), slope(m), offset(n), slope(n));
            }
            quadrics[v] = sum.finish(ring, own(v), params.solver);
        }
    });
    return quadrics;
}

}  // namespace

template <int C>
std::vector<MatrixQuadric<C>> matrix_quadrics(const GridMesh& grid, const RingMesh& rings,
                                              const FeaturePatch& gradients, const SimplifyParams& params) {
    return quadrics_of<C>(
        rings, grid.feature.channels, params, [&](Id v) { return grid.feature.pixel(v); },
        [&](Id v) { return gradients.of_vertex(grid, v); });
}

template <int C>
std::vector<MatrixQuadric<C>> matrix_quadrics(const RingMesh& rings,
                                              const std::vector<MatrixQuadric<C>>& before,
                                              const SimplifyParams& params) {
    Eigen::Index channels = 0;
    for (const MatrixQuadric<C>& quadric : before) channels = std::max(channels, quadric.channels());
    std::vector<float> features(rings.size() * static_cast<std::size_t>(channels));
    const auto at = [&](Id v) { return features.data() + v * static_cast<std::size_t>(channels); };
    for (Id v = 0; v < rings.size(); ++v)
        if (rings[v].live()) before[v].features(rings[v].x, rings[v].y, at(v));
    return quadrics_of<C>(rings, channels, params, at, at);
}

template std::vector<MatrixQuadric<3>> matrix_quadrics(const GridMesh&, const RingMesh&, const FeaturePatch&,
                                                       const SimplifyParams&);
template std::vector<MatrixQuadric<kAnyChannels>> matrix_quadrics(const GridMesh&, const RingMesh&,
                                                                  const FeaturePatch&, const SimplifyParams&);
template std::vector<MatrixQuadric<3>> matrix_quadrics(const RingMesh&, const std::vector<MatrixQuadric<3>>&,
                                                       const SimplifyParams&);
template std::vector<MatrixQuadric<kAnyChannels>> matrix_quadrics(
    const RingMesh&, const std::vector<MatrixQuadric<kAnyChannels>>&, const SimplifyParams&);

}  // namespace imgmesh
