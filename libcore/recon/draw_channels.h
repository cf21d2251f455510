// Draws the reconstruction with all channels of a mesh.
#pragma once

#include "libcore/recon/draw.h"

namespace imgmesh {

/// Draws level `level_index` as draw() does with kMap or kGouraud, with all channels under their names: the
/// colour (R, G, B, or Y if the source has that), A if the source has a mask, then the others, which are 0
/// outside the mask. A channel A of the mesh replaces that of the mask. Throws as draw() does, but a mesh
/// without colour is allowed.
Image draw_channels(const MeshImage& mesh_image, int level_index, const DrawParams& params);

}  // namespace imgmesh
