// Vertex colouring: which vertices can change at the same time.
#pragma once

#include <span>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Returns the vertices of `faces` in colour classes. No two vertices of a class share a face, so a change of
/// one vertex and its faces is not seen by the others. Each vertex, in the order of numbers, gets the first
/// class without a neighbour of it (a planar mesh needs six or seven). Numbers ascend within a class.
/// Vertices without a face are left out. Faces with faces[f][0] == kNone are holes.
std::vector<std::vector<Id>> vertex_coloring(std::span<const Face> faces, std::size_t vertices);

}  // namespace imgmesh
