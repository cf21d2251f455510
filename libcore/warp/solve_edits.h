// From edits to how far every vertex of every level moves.
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// How far each vertex of a level moves [pixels]: size vertex_count(), or empty where none does.
using VertexMoves = std::vector<Vec2f>;

/// One VertexMoves for each level: the sums of what its edits ask for (paper sec. 4.2). Vertices that no
/// edit moves have exactly 0.
///
/// Throws Error(kBadFile) for a level or vertex that is not there, a circle or box without a vertex, a vertex
/// both in a handle and pinned, and moves that are not finite; the text begins with the `where` of the
/// culprit.
std::vector<VertexMoves> solve_edits(const MeshImage& mesh_image, const WarpEdits& edits);

}  // namespace imgmesh
