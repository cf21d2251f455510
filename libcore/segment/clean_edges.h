// Edges without pixels of mixed colour.
#pragma once

#include "libcore/image/image.h"
#include "libcore/segment/cells.h"

namespace imgmesh {

/// Gives each pixel of an L*u*v* image the mean colour of one of the four squares of 3x3 pixels that have it
/// in a corner: of the most uniform one (Kuwahara et al. 1976). A pixel on an edge so takes the colour of one
/// of its sides. At the frame squares are moved inside. Pixels outside the mask (kNone in `cells`) do not
/// count, and are 0. Takes O(pixels) time.
FeatureImage clean_edges(const FeatureImage& image, const Cells& cells);

}  // namespace imgmesh
