// A quadric as the paper writes it, matrix, vector and constant over positions and features (sec. 3.2;
// Garland and Heckbert 1998; Hoppe 1999): any metric and solver, for comparison with the canonical one
// (quadric.h), which is smaller and faster.
#pragma once

#include <algorithm>
#include <vector>

#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/quadrics/matrix_minimum.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// For C: a number of channels that is known only at run time.
inline constexpr int kAnyChannels = Eigen::Dynamic;

/// Q(v) = w'Aw + 2 b'w + c, w = v - origin, for v = (x, y, features). The origin stays near the vertex: about
/// the image's corner, w'Aw and c would be large and nearly cancel. C is 3 or kAnyChannels, for which A and
/// the vectors lie on the heap. 8 (N^2 + 2 N) bytes and a few, N = 2 + channels.
template <int C>
struct MatrixQuadric {
    static constexpr int kChannels = C, kSize = C == kAnyChannels ? Eigen::Dynamic : 2 + C;
    using Vector = Eigen::Matrix<double, kSize, 1>;
    using Matrix = Eigen::Matrix<double, kSize, kSize>;

    Vector origin;
    Matrix a;
    Vector b;
    double c = 0;
    // What find_minimum() finds:
    float px = 0, py = 0;  ///< position of the minimiser [pixels]
    float error = 0;       ///< least value
    bool unique = false;   ///< whether there is one minimiser
    Solver solver = Solver::kClosed;

    /// Zero everywhere. `size`: N; without it the quadric of kAnyChannels has none yet.
    explicit MatrixQuadric(Eigen::Index size = std::max(kSize, 0))
        : origin(Vector::Zero(size)), a(Matrix::Zero(size, size)), b(Vector::Zero(size)) {}

    Eigen::Index channels() const { return origin.size() - 2; }
    double value(const Vector& w) const { return w.dot(a * w + 2 * b) + c; }
    /// As Quadric's.
    float at(float x, float y) const {
        return std::max(0.0f, static_cast<float>(value(PlaneForm<kSize>(a, b).at(from_origin(x, y)))));
    }
    void features(float x, float y, float* out) const {
        const Vector best = origin + PlaneForm<kSize>(a, b).at(from_origin(x, y));
        for (Eigen::Index k = 2; k < best.size(); ++k) *out++ = static_cast<float>(best[k]);
    }
    float best_y(float x) const {
        const PlaneForm<kSize> plane(a, b);
        const double best = -(plane.r.y() + plane.s(0, 1) * (double{x} - origin[0])) / plane.s(1, 1);
        return static_cast<float>(origin[1] + best);
    }
    float best_x(float y) const {
        const PlaneForm<kSize> plane(a, b);
        const double best = -(plane.r.x() + plane.s(0, 1) * (double{y} - origin[1])) / plane.s(0, 0);
        return static_cast<float>(origin[0] + best);
    }
    /// Whether one position is best among those that agree in the fixed coordinates (FixedAxis bits).
    bool has_minimum(std::uint8_t fixed) const {
        if (fixed == 0) return unique;
        const PlaneForm<kSize> plane(a, b);
        const bool free_x = (fixed & kFixedX) == 0, free_y = (fixed & kFixedY) == 0;
        return (!free_x || plane.s(0, 0) > kFlat * plane.steepest) &&
               (!free_y || plane.s(1, 1) > kFlat * plane.steepest);
    }

    void find_minimum() {
        const MatrixMinimum<kSize> least = matrix_minimum<kSize>(a, b, solver);
        unique = least.unique;
        px = static_cast<float>(origin[0] + least.at[0]);
        py = static_cast<float>(origin[1] + least.at[1]);
        error = std::max(0.0f, static_cast<float>(c + b.dot(least.at)));
    }
    /// The same function about another origin.
    MatrixQuadric moved(const Vector& to) const {
        MatrixQuadric q = *this;
        const Vector w = to - origin;
        q.origin = to;
        q.c = value(w);
        q.b += a * w;
        return q;
    }

  private:
    Eigen::Vector2d from_origin(float x, float y) const {
        return {double{x} - origin[0], double{y} - origin[1]};
    }
};

/// Q_i + Q_j, of one size; O(N^3).
template <int C>
MatrixQuadric<C> merged(const MatrixQuadric<C>& i, const MatrixQuadric<C>& j) {
    const typename MatrixQuadric<C>::Vector middle = 0.5 * (i.origin + j.origin);
    MatrixQuadric<C> sum = i.moved(middle);
    const MatrixQuadric<C> other = j.moved(middle);
    sum.a += other.a;
    sum.b += other.b;
    sum.c += other.c;
    sum.find_minimum();
    return sum;
}

/// What vertex_quadrics() are in canonical form, of params' metric, weight and solver.
template <int C>
std::vector<MatrixQuadric<C>> matrix_quadrics(const GridMesh& grid, const RingMesh& rings,
                                              const FeaturePatch& gradients, const SimplifyParams& params);
/// And what current_quadrics() are.
template <int C>
std::vector<MatrixQuadric<C>> matrix_quadrics(const RingMesh& rings,
                                              const std::vector<MatrixQuadric<C>>& before,
                                              const SimplifyParams& params);

}  // namespace imgmesh
