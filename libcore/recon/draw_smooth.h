// The antialiased drawings: flat and wire.
#pragma once

#include "libcore/recon/draw.h"

namespace imgmesh {

/// draw() for kFlat and kWire, whose arguments have been checked.
///
/// Each pixel is the mean, in L*u*v*, of what covers it, by exact areas: no stairs, and no hairlines between
/// faces at any scale. Vertices of the boundary stand as draw_svg() has them, at the outer edge of the
/// outermost pixels. With a mask, alpha is the part of the pixel that is covered.
///
/// Takes 20 bytes for each pixel of a few rows on each thread, beside the image, and O(pixels + edges) time.
/// Throws Error(kUnsupported) if faces or edges lie over one another dozens of times.
Image draw_smooth(const MeshImage& mesh_image, int level_index, const DrawParams& params);

}  // namespace imgmesh
