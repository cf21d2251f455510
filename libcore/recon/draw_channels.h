// The reconstruction with every channel that a mesh has.
#pragma once

#include "libcore/recon/draw.h"

namespace imgmesh {

/// Draws level `level_index` as draw() does, kMap or kGouraud, with all channels under their names: the
/// colour (R, G, B, or Y where the source's is that), A where the source has a mask, then the others, 0
/// outside the mask. A channel A of the mesh takes the place of the mask's. Throws as draw() does, but also
/// draws a mesh without colour.
Image draw_channels(const MeshImage& mesh_image, int level_index, const DrawParams& params);

}  // namespace imgmesh
