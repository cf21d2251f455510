// Solves edits: how far every vertex of every level moves.
#pragma once

#include <string>
#include <vector>

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// How far each vertex of a level moves [pixels]. Size vertex_count(), or empty if none moves.
using VertexMoves = std::vector<Vec2f>;

/// Returns one VertexMoves for each level: the sums of what its edits ask for (paper sec. 4.2). Vertices that
/// no edit moves have exactly 0. Takes O(vertices) time for each direct edit, that of an ArapSolver (arap.h)
/// for each rigid one, and that of an InjectiveSolver (injective.h) for each level with injective ones.
///
/// Throws Error(kBadFile) for a level or vertex that does not exist, a circle or box without a vertex, a
/// vertex that is both pinned and in a handle, and moves that are not finite. The text begins with the
/// `where` of the faulty edit or selection.
std::vector<VertexMoves> solve_edits(const MeshImage& mesh_image, const WarpEdits& edits);

/// What solve_edits() finds, and whether handles are where they should be.
struct EditSolution {
    std::vector<VertexMoves> moves;  ///< of each level
    /// Of each level: the largest distance of a handle of its injective edits from where they ask it to go
    /// [pixels]. Not 0 only where no mesh without folds was found.
    std::vector<double> left;
    std::vector<bool> injective;  ///< of each level: whether it has injective edits
};
EditSolution edit_solution(const MeshImage& mesh_image, const WarpEdits& edits);

/// Returns a line for people for each level where handles are not where they should be.
std::vector<std::string> missed_places(const EditSolution& solution);

}  // namespace imgmesh
