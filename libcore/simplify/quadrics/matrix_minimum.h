// The least point of v'Av + 2 b'v for a positive semidefinite A, three ways (paper sec. 3.2, table 1).
#pragma once

#include <Eigen/Core>

#include "libcore/simplify/metric.h"

namespace imgmesh {

/// Directions along which the function rises by less than this share of what it rises along the steepest are
/// taken for flat: beyond it rounding decides where the minimiser lies.
inline constexpr double kFlat = 1e-10;

/// The function with the last N - 2 coordinates at their best for the first two: p'Sp + 2 r'p + const, the
/// others being -(offset + slope p).
///
/// N is 5, for the paper's three channels, or Eigen::Dynamic, for any other number of them.
template <int N>
struct PlaneForm {
    static constexpr int kOthers = N == Eigen::Dynamic ? Eigen::Dynamic : N - 2;

    Eigen::Matrix2d s;
    Eigen::Vector2d r;
    Eigen::Matrix<double, kOthers, 2> slope;
    Eigen::Matrix<double, kOthers, 1> offset;
    double steepest;  ///< how it rises along a position, other coordinates fixed: the scale of rounding in s

    PlaneForm(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b);
    /// All coordinates at their best for a position.
    Eigen::Matrix<double, N, 1> at(const Eigen::Vector2d& p) const {
        Eigen::Matrix<double, N, 1> v(2 + offset.size());
        v << p, -(offset + slope * p);
        return v;
    }
};

template <int N>
struct MatrixMinimum {
    Eigen::Matrix<double, N, 1> at;  ///< where the function is least; any such point if not unique
    bool unique;
};

/// Where v'Av + 2 b'v is least. A: symmetric, positive semidefinite, its last N - 2 rows and columns
/// definite; b: in A's range, so that there is a least value. N as in PlaneForm.
template <int N>
MatrixMinimum<N> matrix_minimum(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b,
                                Solver solver);

}  // namespace imgmesh
