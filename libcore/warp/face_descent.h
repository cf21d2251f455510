// Minimises the energy of a mesh's faces over the places of its free vertices.
#pragma once

#include <span>
#include <vector>

#include "libcore/warp/face_energy.h"
#include "libcore/warp/hessian_factor.h"
#include "libcore/warp/laplace_factor.h"

namespace imgmesh {

/// The limited-memory quasi-Newton method of Liu et al. 2017, "Quasi-Newton methods for real-time simulation
/// of hyperelastic materials": L-BFGS that starts from the inverse of a Laplacian, factorised once, instead
/// of from a multiple of the identity. Under EnergyKind::Form::kBarrier no face turns over on the way.
class FaceDescent {
  public:
    /// All must outlive it.
    ///
    /// place  of all vertices; the free ones are moved. After changing it or the kind, call restart().
    FaceDescent(const FaceEnergies& energies, const LaplaceFactor& factor, std::vector<Vec2d>& place);

    /// Begins anew from `place`, which has a finite energy of this kind.
    void restart(const EnergyKind& kind);

    /// Makes a step. Returns the largest move of a vertex along an axis [pixels]; 0 if no step lowers the
    /// energy.
    double step();

    /// Makes a step by Newton's method instead, with the Hessian in `newton`.
    double step(HessianFactor& newton);

    double energy() const { return energy_; }

  private:
    struct Pair {
        std::vector<Vec2d> step, change;
        double inverse_product;
    };

    double advance(double slope);
    double slope_along() const;
    void find_direction();
    void remember(double length);

    const FaceEnergies& energies_;
    const LaplaceFactor& factor_;
    std::vector<Vec2d>& place_;
    EnergyKind kind_;
    double energy_ = 0;
    std::vector<Pair> pairs_;  // a ring
    std::size_t known_ = 0, newest_ = 0;
    std::vector<Vec2d> slope_, new_slope_;  // by vertex
    std::vector<Vec2d> direction_;          // by unknown
    std::vector<Vec2d> move_, old_;         // by vertex
};

}  // namespace imgmesh
