// Vertices that can change at the same time.
#pragma once

#include <span>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The vertices of `faces` in classes such that no two of a class share a face, so what one does to itself
/// and its faces none of the others sees. Each vertex, in the order of numbers, goes into the first class
/// that has none of its neighbours (a planar mesh takes six or seven). Numbers ascend in a class; vertices
/// without a face are in none. Faces with faces[f][0] == kNone are holes.
std::vector<std::vector<Id>> vertex_coloring(std::span<const Face> faces, std::size_t vertices);

}  // namespace imgmesh
