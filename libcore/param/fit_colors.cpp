#include "libcore/param/fit_colors.h"

#include <array>

namespace imgmesh {
namespace {

constexpr int C = 3;

// What the pixels of one face say about its three corners: sums of w w' and of w feature'.
struct FaceSums {
    double gram[3][3] = {};
    double rhs[3][C] = {};
};

std::vector<FaceSums> sum_over_pixels(const BaseMesh& mesh, const FeatureImage& feature,
                                      const std::vector<FitTerm>& terms) {
    std::vector<FaceSums> sums(mesh.faces.size());
    for (const FitTerm& term : terms)
        for (std::size_t i = 0; i < term.map->coords.size(); ++i) {
            const PixelCoord& coord = term.map->coords[i];
            if (coord.face == kNone) continue;
            const double w[3] = {1.0 - coord.u - coord.v, coord.u, coord.v};
            FaceSums& sum = sums[coord.face];
            const float* f = feature.pixel(i);
            for (int a = 0; a < 3; ++a) {
                const double wa = term.weight * w[a];
                for (int b = 0; b < 3; ++b) sum.gram[a][b] += wa * w[b];
                for (int c = 0; c < C; ++c) sum.rhs[a][c] += wa * f[c];
            }
        }
    return sums;
}

using Vector = Eigen::Matrix<double, Eigen::Dynamic, C, Eigen::RowMajor>;

Vector multiply(const BaseMesh& mesh, const std::vector<FaceSums>& sums, const Vector& x) {
    Vector y = Vector::Zero(x.rows(), C);
    for (std::size_t f = 0; f < sums.size(); ++f)
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b)
                y.row(mesh.faces[f][a]) += sums[f].gram[a][b] * x.row(mesh.faces[f][b]);
    return y;
}

}  // namespace

void fit_colors(BaseMesh& mesh, const FeatureImage& feature, const std::vector<FitTerm>& terms) {
    const std::vector<FaceSums> sums = sum_over_pixels(mesh, feature, terms);
    const auto vertices = static_cast<Eigen::Index>(mesh.vertex_count());
    Vector rhs = Vector::Zero(vertices, C), x(vertices, C);
    Eigen::VectorXd diagonal = Eigen::VectorXd::Zero(vertices);
    for (std::size_t f = 0; f < sums.size(); ++f)
        for (std::size_t a = 0; a < 3; ++a) {
            const Id v = mesh.faces[f][a];
            diagonal[v] += sums[f].gram[a][a];
            for (int c = 0; c < C; ++c) rhs(v, c) += sums[f].rhs[a][c];
        }
    for (Eigen::Index v = 0; v < vertices; ++v)
        for (int c = 0; c < C; ++c) x(v, c) = mesh.feature_of(static_cast<Id>(v))[c];

    // A vertex that only pixels with tiny weights touch would be free to run away: pull it weakly to where it
    // is.
    const double pull = 1e-3;
    rhs += pull * x;
    diagonal.array() += pull;

    // Jacobi-preconditioned conjugate gradients, the channels side by side.
    Vector residual = rhs - multiply(mesh, sums, x) - pull * x;
    const Eigen::VectorXd inverse = diagonal.cwiseInverse();
    Vector z = inverse.asDiagonal() * residual;
    Vector p = z;
    Eigen::Array<double, 1, C> rz = (residual.array() * z.array()).colwise().sum();
    const Eigen::Array<double, 1, C> enough =
        1e-10 * ((rhs.array() * (inverse.asDiagonal() * rhs).array()).colwise().sum() + 1e-30);
    for (int iteration = 0; iteration < 100 && (rz > enough).any(); ++iteration) {
        const Vector ap = multiply(mesh, sums, p) + pull * p;
        const Eigen::Array<double, 1, C> alpha = rz / ((p.array() * ap.array()).colwise().sum() + 1e-300);
        x.array() += p.array().rowwise() * alpha;
        residual.array() -= ap.array().rowwise() * alpha;
        z = inverse.asDiagonal() * residual;
        const Eigen::Array<double, 1, C> next = (residual.array() * z.array()).colwise().sum();
        const Eigen::Array<double, 1, C> beta = next / (rz + 1e-300);
        p = (z.array() + p.array().rowwise() * beta).matrix();
        rz = next;
    }
    for (Eigen::Index v = 0; v < vertices; ++v)
        for (int c = 0; c < C; ++c) mesh.feature_of(static_cast<Id>(v))[c] = static_cast<float>(x(v, c));
}

}  // namespace imgmesh
