// Takes vertices away from the straight sides of a mesh.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Removes vertices of the boundary, each on the straight line between its two neighbours along it. The faces
/// around each are replaced by others between its neighbours, one fewer, the best shaped first; all have a
/// positive area. The others keep their order and places.
///
/// gone  ascending
void remove_side_vertices(BaseMesh& mesh, const std::vector<Id>& gone);

}  // namespace imgmesh
