// The collapse of a base mesh: how coarser levels of a tile set are made, which have no pixels.
#pragma once

#include <vector>

#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// Collapses edges of a mesh of the rectangle from (0, 0) to `corner` as simplify() does those of
/// the dense mesh. Quadrics are those of the mesh's faces and its vertices' features. On the rectangle's
/// sides `side_vertices` and the corners are left, with the features that their quadrics have for them; where
/// the mesh has other boundaries, as that of a mask, all of their vertices are left.
///
/// Vertices of the result are in the order of those that they come from. A mesh in which a vertex has more
/// than kMaxValence neighbours, or several fans of faces, is changed before (fit_for_rings()).
///
/// Throws Error: kUnsupported for another metric or solver than the first, kBadArgument for the number of
/// features as simplify() does. O(n). Deterministic, with any number of threads.
SimplifyResult simplify_mesh(const BaseMesh& mesh, const Vec2f& corner, const std::vector<Id>& side_vertices,
                             const SimplifyParams& params, const SimplifyTarget& target);

}  // namespace imgmesh
