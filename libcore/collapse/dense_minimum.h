// The least point of v'Av + 2 b'v for a positive semidefinite A, three ways (paper sec. 3.2, table 1).
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "libcore/collapse/metric.h"

namespace imgmesh {

/// Directions along which the function rises by less than this share of what it rises along the steepest are
/// taken for flat: beyond it rounding decides where the minimiser lies.
inline constexpr double kFlat = 1e-10;

/// The function with the last N - 2 coordinates at their best for the first two: p'Sp + 2 r'p + const, the
/// others being -(offset + slope p).
template <int N>
struct PlaneForm {
    Eigen::Matrix2d s;
    Eigen::Vector2d r;
    Eigen::Matrix<double, N - 2, 2> slope;
    Eigen::Matrix<double, N - 2, 1> offset;
    double steepest = 0;  ///< along a position, other coordinates fixed: the scale of rounding in s

    PlaneForm(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b) {
        const Eigen::LDLT<Eigen::Matrix<double, N - 2, N - 2>> others(
            a.template bottomRightCorner<N - 2, N - 2>());
        const auto coupling = a.template bottomLeftCorner<N - 2, 2>();
        slope = others.solve(coupling);
        offset = others.solve(b.template tail<N - 2>());
        s = a.template topLeftCorner<2, 2>() - coupling.transpose() * slope;
        r = b.template head<2>() - coupling.transpose() * offset;
        steepest = a(0, 0) + a(1, 1);
    }
    /// All coordinates at their best for a position.
    Eigen::Matrix<double, N, 1> at(const Eigen::Vector2d& p) const {
        Eigen::Matrix<double, N, 1> v;
        v << p, -(offset + slope * p);
        return v;
    }
};

template <int N>
struct DenseMinimum {
    Eigen::Matrix<double, N, 1> at;  ///< where the function is least; any such point if not unique
    bool unique;
};

/// Where v'Av + 2 b'v is least. A: symmetric, positive semidefinite, its last N - 2 rows and columns
/// definite; b: in A's range, so that there is a least value.
template <int N>
DenseMinimum<N> dense_minimum(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b,
                              Solver solver) {
    using Matrix = Eigen::Matrix<double, N, N>;
    if (solver == Solver::kSvd) {
        const Eigen::JacobiSVD<Matrix> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
        const Eigen::Matrix<double, N, 1>& scales = svd.singularValues();  // in descending order
        Eigen::Matrix<double, N, 1> along = svd.matrixU().transpose() * b;
        for (int k = 0; k < N; ++k) along[k] = scales[k] > kFlat * scales[0] ? along[k] / scales[k] : 0;
        return {-(svd.matrixV() * along), scales[N - 1] > kFlat * scales[0]};
    }
    if (solver == Solver::kLu) {
        Eigen::FullPivLU<Matrix> lu(a);
        lu.setThreshold(kFlat);
        return {-lu.solve(b), lu.rank() == N};
    }
    const PlaneForm<N> plane(a, b);
    const Eigen::Matrix2d& s = plane.s;
    const double trace = s.trace(), det = s.determinant();
    if (!(trace > kFlat * plane.steepest)) return {plane.at(Eigen::Vector2d::Zero()), false};
    // Of rank one r is an eigenvector, of the eigenvalue that is the trace.
    if (!(det > kFlat * plane.steepest * trace)) return {plane.at(-plane.r / trace), false};
    const Eigen::Vector2d p(s(0, 1) * plane.r.y() - s(1, 1) * plane.r.x(),
                            s(0, 1) * plane.r.x() - s(0, 0) * plane.r.y());
    return {plane.at(p / det), true};
}

}  // namespace imgmesh
