// Which faces of a base mesh share an edge.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// For each face the faces across the edges opposite its corners a, b, c; kNone on the border.
std::vector<Face> face_neighbors(const BaseMesh& mesh);

}  // namespace imgmesh
