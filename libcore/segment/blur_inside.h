// A slight blur, which takes away the noise of single pixels.
#pragma once

#include "libcore/image/image.h"
#include "libcore/segment/cells.h"

namespace imgmesh {

/// Returns the L*u*v* image blurred by 1 4 6 4 1 along rows and columns, about a Gaussian of one pixel.
/// Pixels outside the mask (kNone in `cells`) do not count, and are 0. Takes O(pixels) time.
FeatureImage blur_inside(const FeatureImage& image, const Cells& cells);

}  // namespace imgmesh
