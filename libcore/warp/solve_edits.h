// Solves edits: how far every vertex of every level moves.
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// How far each vertex of a level moves [pixels]. Size vertex_count(), or empty if none moves.
using VertexMoves = std::vector<Vec2f>;

/// Returns one VertexMoves for each level: the sums of what its edits ask for (paper sec. 4.2). Vertices that
/// no edit moves have exactly 0. Takes O(vertices) time for each direct edit, and that of an ArapSolver
/// (arap.h) for each other one.
///
/// Throws Error(kBadFile) for a level or vertex that does not exist, a circle or box without a vertex, a
/// vertex that is both pinned and in a handle, and moves that are not finite. The text begins with the
/// `where` of the faulty edit or selection.
std::vector<VertexMoves> solve_edits(const MeshImage& mesh_image, const WarpEdits& edits);

}  // namespace imgmesh
