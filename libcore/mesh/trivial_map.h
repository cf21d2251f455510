// The pixel map from which every other one starts.
#pragma once

#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Returns the paper's trivial map (sec. 3.4, fig. 5 e): each pixel of a width x height image keeps its
/// place, in the face that covers its centre; on shared edges the lowest such face. It is kNone without such
/// a face and outside the mask (empty(), or of that size). Weights lie on the kFloatWeightStep grid.
/// Guarantees, cost and assumptions are those of rasterize().
PixelMap trivial_map(const BaseMesh& mesh, int width, int height, const Mask& mask = {});

}  // namespace imgmesh
