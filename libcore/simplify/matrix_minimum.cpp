#include "libcore/simplify/matrix_minimum.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <type_traits>

namespace imgmesh {
namespace {

// Beyond the paper's five dimensions one solver of any size, so that compiling does not take minutes.
template <int N>
using Solved = std::conditional_t<N == 5, Eigen::Matrix<double, N, N>,
                                  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 18, 18>>;
template <class Matrix>
using Column = Eigen::Matrix<double, Matrix::RowsAtCompileTime, 1, 0, Matrix::MaxRowsAtCompileTime, 1>;

template <class Matrix>
bool solve_svd(const Matrix& a, Column<Matrix>& v) {
    const Eigen::JacobiSVD<Matrix> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const auto& scales = svd.singularValues();  // in descending order
    Column<Matrix> along = svd.matrixU().transpose() * v;
    for (Eigen::Index k = 0; k < along.size(); ++k)
        along[k] = scales[k] > kFlat * scales[0] ? along[k] / scales[k] : 0;
    v = svd.matrixV() * along;
    return scales[along.size() - 1] > kFlat * scales[0];
}

template <class Matrix>
bool solve_lu(const Matrix& a, Column<Matrix>& v) {
    Eigen::FullPivLU<Matrix> lu(a);
    lu.setThreshold(kFlat);
    v = lu.solve(v).eval();
    return lu.rank() == a.rows();
}

template <int N>
MatrixMinimum<N> closed_minimum(const PlaneForm<N>& plane) {
    const Eigen::Matrix2d& s = plane.s;
    const double trace = s.trace(), det = s.determinant();
    if (!(trace > kFlat * plane.steepest)) return {plane.at(Eigen::Vector2d::Zero()), false};
    // Of rank one r is an eigenvector, of the eigenvalue that is the trace.
    if (!(det > kFlat * plane.steepest * trace)) return {plane.at(-plane.r / trace), false};
    const Eigen::Vector2d p(s(0, 1) * plane.r.y() - s(1, 1) * plane.r.x(),
                            s(0, 1) * plane.r.x() - s(0, 0) * plane.r.y());
    return {plane.at(p / det), true};
}

}  // namespace

template <int N>
PlaneForm<N>::PlaneForm(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b) {
    constexpr int C = N - 2;
    const Eigen::LDLT<Eigen::Matrix<double, C, C>> others(a.template bottomRightCorner<C, C>());
    const auto coupling = a.template bottomLeftCorner<C, 2>();
    slope = others.solve(coupling);
    offset = others.solve(b.template tail<C>());
    s = a.template topLeftCorner<2, 2>() - coupling.transpose() * slope;
    r = b.template head<2>() - coupling.transpose() * offset;
    steepest = a(0, 0) + a(1, 1);
}

template <int N>
MatrixMinimum<N> matrix_minimum(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b,
                                Solver solver) {
    if (solver == Solver::kClosed) return closed_minimum(PlaneForm<N>(a, b));
    Column<Solved<N>> v = -b;
    const bool unique = solver == Solver::kSvd ? solve_svd<Solved<N>>(a, v) : solve_lu<Solved<N>>(a, v);
    return {v, unique};
}

template struct PlaneForm<5>;
template struct PlaneForm<10>;
template struct PlaneForm<18>;
template MatrixMinimum<5> matrix_minimum(const Eigen::Matrix<double, 5, 5>&,
                                         const Eigen::Matrix<double, 5, 1>&, Solver);
template MatrixMinimum<10> matrix_minimum(const Eigen::Matrix<double, 10, 10>&,
                                          const Eigen::Matrix<double, 10, 1>&, Solver);
template MatrixMinimum<18> matrix_minimum(const Eigen::Matrix<double, 18, 18>&,
                                          const Eigen::Matrix<double, 18, 1>&, Solver);

}  // namespace imgmesh
