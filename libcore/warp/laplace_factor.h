// The Laplacian of a mesh with some vertices fixed, factorised.
#pragma once

#include <span>
#include <vector>

#include "libcore/base/types.h"
#include "libcore/warp/face_energy.h"

namespace imgmesh {

/// Solves with the Laplacian of the faces of a mesh at rest (stiffness of linear elements), times `scale`.
/// The unknowns are numbered so that the factor is sparse; free() tells which vertex each is.
class LaplaceFactor {
  public:
    /// is_free  by vertex; each connected part of the faces needs a vertex that is not free
    LaplaceFactor(const FaceEnergies& energies, const std::vector<bool>& is_free, double scale);

    const std::vector<Id>& free() const { return free_; }

    /// Overwrites the right-hand sides, by unknown, by the solution. Takes O(V log V) time.
    void solve(std::span<Vec2d> right) const;

    /// Overwrites the moves of the free vertices by the harmonic ones for the moves of the others.
    void extend(std::span<Vec2d> move) const;

  private:
    struct Entry {
        int row;
        double value;
    };
    struct Link {
        int unknown;
        Id fixed;
        double value;
    };
    std::vector<Id> free_;
    std::vector<int> first_;  // column j of the factor has the entries [first_[j], first_[j + 1])
    std::vector<Entry> entries_;
    std::vector<double> inverse_diagonal_;
    std::vector<Link> links_;  // of unknowns to fixed vertices
};

}  // namespace imgmesh
