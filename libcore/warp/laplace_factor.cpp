#include "libcore/warp/laplace_factor.h"

#include <Eigen/SparseCholesky>

#include "libcore/base/index.h"

namespace imgmesh {

LaplaceFactor::LaplaceFactor(const FaceEnergies& energies, const std::vector<bool>& is_free, double scale) {
    std::vector<int> unknown(is_free.size(), -1);
    for (Id v = 0; v < is_free.size(); ++v) {
        if (!is_free[v]) continue;
        unknown[v] = as_int(free_.size());
        free_.push_back(v);
    }
    const int size = as_int(free_.size());
    first_.assign(1, 0);
    if (size == 0) return;
    std::vector<Eigen::Triplet<double>> triplets;
    energies.for_pairs([&](Id i, Id j, double value) {
        if (unknown[i] < 0) return;
        if (unknown[j] >= 0)
            triplets.emplace_back(unknown[i], unknown[j], scale * value);
        else
            links_.push_back({unknown[i], j, scale * value});
    });
    Eigen::SparseMatrix<double> matrix(size, size);
    matrix.setFromTriplets(triplets.begin(), triplets.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    // Unknowns take the factor's order, so that nothing has to be permuted later.
    const auto& order = factor.permutationP().indices();
    std::vector<Id> ordered(free_.size());
    for (int i = 0; i < size; ++i) ordered[as_index(order[i])] = free_[as_index(i)];
    for (Link& link : links_) link.unknown = order[link.unknown];
    free_ = std::move(ordered);
    const auto& lower = factor.matrixL().nestedExpression();
    for (int j = 0; j < size; ++j) {
        for (std::decay_t<decltype(lower)>::InnerIterator entry(lower, j); entry; ++entry)
            entries_.push_back({static_cast<int>(entry.row()), entry.value()});
        first_.push_back(as_int(entries_.size()));
        inverse_diagonal_.push_back(1 / factor.vectorD()[j]);
    }
}

void LaplaceFactor::solve(std::span<Vec2d> right) const {
    const std::size_t size = free_.size();
    for (std::size_t j = 0; j < size; ++j) {
        const Vec2d value = right[j];
        for (int k = first_[j]; k < first_[j + 1]; ++k) {
            const Entry& e = entries_[as_index(k)];
            right[as_index(e.row)] -= e.value * value;
        }
    }
    for (std::size_t j = size; j-- > 0;) {
        Vec2d value = inverse_diagonal_[j] * right[j];
        for (int k = first_[j]; k < first_[j + 1]; ++k) {
            const Entry& e = entries_[as_index(k)];
            value -= e.value * right[as_index(e.row)];
        }
        right[j] = value;
    }
}

void LaplaceFactor::extend(std::span<Vec2d> move) const {
    std::vector<Vec2d> right(free_.size(), Vec2d(0, 0));
    for (const Link& link : links_) right[as_index(link.unknown)] -= link.value * move[link.fixed];
    solve(right);
    for (std::size_t i = 0; i < free_.size(); ++i) move[free_[i]] = right[i];
}

}  // namespace imgmesh
