// The pixel map that every other one starts from.
#pragma once

#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// The paper's trivial map (sec. 3.4, fig. 5 e): every pixel of a width x height image lies where it is, in
/// the face that covers its centre; on shared edges in the lowest such face. kNone where no face does, and
/// outside the mask, which is empty() or of that size.
/// Weights lie on the kFloatWeightStep grid. Guarantees, cost and assumptions as rasterize().
PixelMap trivial_map(const BaseMesh& mesh, int width, int height, const Mask& mask = {});

}  // namespace imgmesh
