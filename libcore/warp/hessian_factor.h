// The Hessian of the energy of a mesh's faces, factorised.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "libcore/warp/face_energy.h"

namespace imgmesh {

/// Solves with the Hessian by the places of the free vertices. That of each face is made positive
/// semidefinite first: negative eigenvalues become 0.
class HessianFactor {
  public:
    /// `energies` must outlive it. unknowns  the free vertices, in the order of solve()
    HessianFactor(const FaceEnergies& energies, std::size_t vertices, const std::vector<Id>& unknowns);
    ~HessianFactor();

    /// Factorises the Hessian at `place`. Returns whether that was possible.
    bool factorise(const EnergyKind& kind, std::span<const Vec2d> place);

    /// Overwrites the right-hand sides, by unknown, by the solution.
    void solve(std::span<Vec2d> right) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace imgmesh
