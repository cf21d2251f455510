// Finds the faces of a base mesh that share an edge.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Returns for each face the faces across the edges opposite its corners a, b, c; kNone on a boundary.
std::vector<Face> face_neighbors(const BaseMesh& mesh);

}  // namespace imgmesh
