#include "libcore/warp/hessian_factor.h"

#include <Eigen/SparseCholesky>
#include <algorithm>

#include "libcore/base/index.h"

namespace imgmesh {

struct HessianFactor::State {
    explicit State(const FaceEnergies& all) : energies(all) {}

    const FaceEnergies& energies;
    Eigen::SparseMatrix<double> matrix;  // the lower triangle
    // Of each entry of FaceEnergies::hessian(), in its order, where in the matrix it goes, or -1.
    std::vector<int> slots;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor;
    Eigen::VectorXd right, found;
};

HessianFactor::HessianFactor(const FaceEnergies& energies, std::size_t vertices,
                             const std::vector<Id>& unknowns)
    : state_(std::make_unique<State>(energies)) {
    State& s = *state_;
    std::vector<int> unknown(vertices, -1);
    for (std::size_t i = 0; i < unknowns.size(); ++i) unknown[unknowns[i]] = as_int(i);
    const int size = 2 * as_int(unknowns.size());
    std::vector<std::pair<int, int>> places;
    std::vector<Eigen::Triplet<double>> triplets;
    energies.for_pairs([&](Id i, Id j, double) {
        for (int r = 0; r < 2; ++r)
            for (int c = 0; c < 2; ++c) {
                int row = 2 * unknown[i] + r, column = 2 * unknown[j] + c;
                const bool there = unknown[i] >= 0 && unknown[j] >= 0 && row >= column;
                places.emplace_back(there ? row : -1, column);
                if (there) triplets.emplace_back(row, column, 1.0);
            }
    });
    s.matrix.resize(size, size);
    s.matrix.setFromTriplets(triplets.begin(), triplets.end());
    s.matrix.makeCompressed();
    for (const auto& [row, column] : places) {
        if (row < 0) {
            s.slots.push_back(-1);
            continue;
        }
        const int* const first = s.matrix.innerIndexPtr() + s.matrix.outerIndexPtr()[column];
        const int* const last = s.matrix.innerIndexPtr() + s.matrix.outerIndexPtr()[column + 1];
        s.slots.push_back(as_int(std::lower_bound(first, last, row) - s.matrix.innerIndexPtr()));
    }
    s.factor.analyzePattern(s.matrix);
    s.right.resize(size);
}
HessianFactor::~HessianFactor() = default;

bool HessianFactor::factorise(const EnergyKind& kind, std::span<const Vec2d> place) {
    State& s = *state_;
    double* const values = s.matrix.valuePtr();
    std::fill(values, values + s.matrix.nonZeros(), 0.0);
    auto slot = s.slots.begin();
    s.energies.hessian(kind, place, [&](double value) {
        if (*slot >= 0) values[*slot] += value;
        ++slot;
    });
    // Faces may be soft in all directions at once.
    constexpr double kFloor = 1e-6;
    for (int i = 0; i < s.matrix.cols(); ++i) values[s.matrix.outerIndexPtr()[i]] += kFloor;
    s.factor.factorize(s.matrix);
    return s.factor.info() == Eigen::Success;
}

void HessianFactor::solve(std::span<Vec2d> right) const {
    State& s = *state_;
    for (std::size_t i = 0; i < right.size(); ++i) s.right.segment<2>(2 * as_int(i)) = right[i];
    s.found = s.factor.solve(s.right);
    for (std::size_t i = 0; i < right.size(); ++i) right[i] = s.found.segment<2>(2 * as_int(i));
}

}  // namespace imgmesh
