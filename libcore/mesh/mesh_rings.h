// A base mesh as rings, to be collapsed further.
#pragma once

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/ring_mesh.h"

namespace imgmesh {

/// Changes the mesh so that each vertex fits a Ring: a vertex with several fans of faces becomes one for
/// each, appended with its features, and edges at a vertex with more than kMaxValence neighbours are flipped.
/// All areas stay positive.
///
/// Takes O(faces) time. Throws Error(kUnsupported) if a vertex keeps too many neighbours whatever is flipped.
void fit_for_rings(BaseMesh& mesh);

/// Returns the rings of such a mesh, with its numbers; a vertex in no face is removed. On a straight stretch
/// of the boundary along a side of the rectangle from (0, 0) to `corner` a vertex keeps one
/// coordinate, elsewhere on the boundary both.
RingMesh mesh_rings(const BaseMesh& mesh, const Vec2f& corner);

}  // namespace imgmesh
