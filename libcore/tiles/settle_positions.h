// Positions of a coarser tile on the grid that files have.
#pragma once

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Puts all positions on multiples of kPositionStep. A vertex inside for which there is no such place is cut
/// out: it is in a sliver, as beside a long side of a flat picture. Vertices of the boundary stay where they
/// are.
///
/// mesh  a triangulation with positive areas
void settle_positions(BaseMesh& mesh);

}  // namespace imgmesh
