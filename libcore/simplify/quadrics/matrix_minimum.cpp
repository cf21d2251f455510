// Sources: paper sec. 3.2 and table 1; `closed` is docs/decisions/0001-canonical-quadric.md for any matrix.
#include "libcore/simplify/quadrics/matrix_minimum.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SVD>

namespace imgmesh {
namespace {

template <int N>
MatrixMinimum<N> svd_minimum(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b) {
    // A preconditioner is for matrices that are not square, and takes long to compile.
    const Eigen::JacobiSVD<Eigen::Matrix<double, N, N>, Eigen::NoQRPreconditioner> svd(
        a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const auto& scales = svd.singularValues();  // in descending order
    const Eigen::Matrix<double, N, 1> v = -b;
    Eigen::Matrix<double, N, 1> along = svd.matrixU().transpose() * v;
    for (Eigen::Index k = 0; k < along.size(); ++k)
        along[k] = scales[k] > kFlat * scales[0] ? along[k] / scales[k] : 0;
    return {svd.matrixV() * along, scales[along.size() - 1] > kFlat * scales[0]};
}

template <int N>
MatrixMinimum<N> lu_minimum(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b) {
    Eigen::FullPivLU<Eigen::Matrix<double, N, N>> lu(a);
    lu.setThreshold(kFlat);
    const Eigen::Matrix<double, N, 1> v = -b;
    return {lu.solve(v), lu.rank() == a.rows()};
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
    constexpr int C = kOthers;
    const Eigen::Index channels = a.rows() - 2;
    const Eigen::LDLT<Eigen::Matrix<double, C, C>> others(
        a.template bottomRightCorner<C, C>(channels, channels));
    const auto coupling = a.template bottomLeftCorner<C, 2>(channels, 2);
    // Column by column: Eigen's solver of many columns at once is slower here, and takes long to compile.
    slope.resize(channels, 2);
    for (int k = 0; k < 2; ++k) slope.col(k) = others.solve(coupling.col(k));
    offset = others.solve(b.template bottomRows<C>(channels));
    s = a.template topLeftCorner<2, 2>() - coupling.transpose() * slope;
    r = b.template head<2>() - coupling.transpose() * offset;
    steepest = a(0, 0) + a(1, 1);
}

template <int N>
MatrixMinimum<N> matrix_minimum(const Eigen::Matrix<double, N, N>& a, const Eigen::Matrix<double, N, 1>& b,
                                Solver solver) {
    switch (solver) {
        case Solver::kClosed:
            return closed_minimum(PlaneForm<N>(a, b));
        case Solver::kSvd:
            return svd_minimum<N>(a, b);
        case Solver::kLu:
            return lu_minimum<N>(a, b);
    }
    __builtin_unreachable();
}

template struct PlaneForm<5>;
template struct PlaneForm<Eigen::Dynamic>;
template MatrixMinimum<5> matrix_minimum(const Eigen::Matrix<double, 5, 5>&,
                                         const Eigen::Matrix<double, 5, 1>&, Solver);
template MatrixMinimum<Eigen::Dynamic> matrix_minimum(const Eigen::MatrixXd&, const Eigen::VectorXd&, Solver);

}  // namespace imgmesh
