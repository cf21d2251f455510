// The contrast along the outlines of regions, with their directions known.
#pragma once

#include "libcore/segment/labels.h"
#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// Returns the contrast of every pair of neighbours in different regions, in [0, 1]: HalfDiscs::contrast()
/// across the outline's direction there, which is that of the pairs of the same two regions within 4 pixels.
/// Larger images are measured at a smaller size (SmallImage), where several pairs share a contrast. The image
/// is L*u*v*, of the regions' size. The result is the same for any number of threads. Takes O(pixels) time
/// plus some microseconds for each pair at the smaller size.
PairContrasts contour_contrasts(const FeatureImage& image, const LabelImage& regions);

}  // namespace imgmesh
