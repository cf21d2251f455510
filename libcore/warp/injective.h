// Deformation of a base mesh in which no face turns over, for programs that drag handles. solve_edits.h
// solves whole edits.
#pragma once

#include <memory>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Moves a mesh so that given vertices reach given places, no face turns over, and faces keep their shape and
/// size as far as possible: the sum over faces of their area times |J|^2 + |J^-1|^2 is made small, where J is
/// the face's linear map (the symmetric Dirichlet energy of Smith and Schaefer 2015, "Bijective
/// parameterization with free boundaries").
///
/// As in ArapSolver (arap.h), what depends on the mesh and on *which* vertices are fixed is factorised once
/// for all calls of solve(). The result is the same bits on any machine and with any compiler. Connected
/// parts of the mesh without a fixed vertex stay where they are.
class InjectiveSolver {
  public:
    /// mesh   with faces of positive area; one without stays out of account
    /// fixed  the vertices whose places are given, ascending, each once: handles and pins alike
    InjectiveSolver(const BaseMesh& mesh, const std::vector<Id>& fixed);
    ~InjectiveSolver();
    InjectiveSolver(InjectiveSolver&&) noexcept;
    InjectiveSolver& operator=(InjectiveSolver&&) noexcept;

    /// The moves that solve() finds.
    struct Result {
        /// Of every vertex [pixels]. With them every face has a positive area, and it still has if all places
        /// are rounded to kPositionStep, as in a container.
        std::vector<Vec2f> moves;
        /// The largest distance of a fixed vertex from where it was to go [pixels]. 0 if each has exactly the
        /// move that was asked for (as float).
        double left = 0;
        int iterations = 0;
    };
    /// Returns the moves of all vertices for given moves of the fixed ones.
    ///
    /// moves           of the fixed vertices, in their order [pixels]
    /// start           moves of all vertices to begin with, as from the last step of a drag; if empty, or if
    ///                 a face turns over with them, the mesh at rest. Other starts may end in other minima.
    /// max_iterations  of all stages together, each O(V log V)
    ///
    /// Where no unfolded mesh is found with all fixed vertices at their places, those that stay keep theirs,
    /// the others come as near as a straight way allows, and `left` tells. If all moves of a connected part
    /// are equal, the part moves by exactly that.
    Result solve(const std::vector<Vec2d>& moves, const std::vector<Vec2f>& start = {},
                 int max_iterations = 400) const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace imgmesh
