// A mesh as parts without holes, each with its boundary first: what engines take for a deformable sprite.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/disc_part.h"

namespace imgmesh {

/// Cuts `mesh` into discs: one for each set of faces that hang together by edges, in the order of their first
/// faces. Each hole is joined to the outer boundary by a seam along edges of the mesh, the shortest as a
/// whole; the boundary runs along both of its sides, so that its vertices are in the part twice. Faces that
/// share only a vertex get a copy of it each. Vertices without a face are left out.
///
/// mesh  every edge has at most two faces, which run along it in opposite directions
///
/// Takes O(F log F) time. Throws Error(kInternal) for a mesh that no seams can make a disc of, such as a
/// closed surface.
std::vector<DiscPart> disc_parts(const BaseMesh& mesh);

}  // namespace imgmesh
