// As-rigid-as-possible deformation of a base mesh, for programs that drag handles. solve_edits.h solves whole
// edits.
#pragma once

#include <memory>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Moves a mesh so that given vertices reach given places, and every one-ring is turned but hardly stretched.
/// It is the local/global iteration of Sorkine and Alexa 2007, "As-rigid-as-possible surface modeling", in
/// the plane, where the best rotation of a one-ring is one arc tangent. The matrix depends on the mesh and on
/// *which* vertices are fixed. It is factorised once for all calls of solve(), so dragging a handle costs
/// only the iterations, each O(V log V).
///
/// Connected parts of the mesh without a fixed vertex stay where they are.
class ArapSolver {
  public:
    /// fixed  the vertices whose places are given, ascending, each once: handles and pins alike
    ArapSolver(const BaseMesh& mesh, const std::vector<Id>& fixed);
    ~ArapSolver();
    ArapSolver(ArapSolver&&) noexcept;
    ArapSolver& operator=(ArapSolver&&) noexcept;

    /// The moves that solve() finds.
    struct Result {
        std::vector<Vec2d> moves;  ///< of every vertex [pixels]
        int iterations = 0;
    };
    /// Returns the moves of all vertices for given moves of the fixed ones.
    ///
    /// moves  of the fixed vertices, in their order [pixels]
    /// start  moves of all vertices to begin with, as from the last step of a drag; if empty, the rigid
    ///        motion nearest to the given moves. Other starts may end in other minima.
    ///
    /// Iterates until no vertex moves by more than `tolerance` [pixels] in an iteration, or for
    /// `max_iterations`. The result does not depend on earlier calls. If all moves are equal, the whole mesh
    /// moves by exactly that.
    Result solve(const std::vector<Vec2d>& moves, double tolerance = 1e-3, int max_iterations = 200,
                 const std::vector<Vec2d>& start = {}) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace imgmesh
