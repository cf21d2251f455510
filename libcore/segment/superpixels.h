// Superpixels: regions of similar size that follow edges.
#pragma once

#include "libcore/segment/segment.h"

namespace imgmesh {

/// segment() for params.superpixels, which must be given, from the cells of the map's patches. They merge by
/// superpixel_distance until four times as many are left as wanted; refine_outlines moves the outlines of
/// these; then the same again with the number wanted. Colours are those of the image blurred by a pixel
/// and with clean edges (blur_inside, clean_edges). Where cells are few, squares of half the spacing cut them
/// first, so that only the pixels limit the number. Parameters and sizes are checked by segment().
Segmentation superpixels(const Level& level, const Cells& patches, const FeatureImage& image,
                         const SegmentParams& params, const Progress& progress);

}  // namespace imgmesh
