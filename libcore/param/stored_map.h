// The weights that a container holds of a map on a grid.
#pragma once

#include <optional>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/displacements.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// The least twice-area of a pixel triangle that stored weights keep [px^2]: far above the rounding errors of
/// single precision.
inline constexpr double kLeastStoredArea = 1.0 / 256;

/// Returns the map of pixels that lie on the mesh (locate_map.h) and fold no triangle, with weights of
/// `wanted` precision; without a choice with half ones if every triangle of pixels (both diagonals of each
/// 2x2 cell) keeps kLeastStoredArea with them and is not folded by displacements_of() either, else with
/// floats. In large faces half weights may fold triangles, as their step is a face's extent / 2048. Throws
/// Error(kUnsupported) if half weights are wanted and do not keep the areas.
PixelMap stored_map(const BaseMesh& mesh, const Displacements& places, std::optional<WeightPrecision> wanted);

}  // namespace imgmesh
