// How vertices may move without a change of the mesh's outline.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Coordinates that a vertex keeps, as bits.
inline constexpr std::uint8_t kFixedX = 1, kFixedY = 2;

/// Returns the coordinates that each vertex keeps: none inside the mesh. A vertex of the boundary may slide
/// where the boundary runs straight along one side of the bounding box; all others keep both.
std::vector<std::uint8_t> fixed_axes(const BaseMesh& mesh);

}  // namespace imgmesh
