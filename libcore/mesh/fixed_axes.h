// How vertices may move without a change of the mesh's outline.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Coordinates that a vertex keeps, as bits, and whether it keeps its colour too.
inline constexpr std::uint8_t kFixedX = 1, kFixedY = 2, kFixedColor = 4;

/// Returns the coordinates that each vertex keeps: none inside the mesh. A vertex of the boundary may slide
/// where the boundary runs straight along one side of the bounding box; all others keep both.
///
/// tile  the image of a tile, whose vertices on the image's sides keep everything; null if there are none
std::vector<std::uint8_t> fixed_axes(const BaseMesh& mesh, const GridSize* tile = nullptr);

inline bool keeps_place(std::uint8_t fixed) {
    return (fixed & kFixedX) && (fixed & kFixedY);
}

}  // namespace imgmesh
