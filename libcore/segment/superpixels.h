// Superpixels: regions of similar size that follow edges.
#pragma once

#include "libcore/segment/segment.h"

namespace imgmesh {

/// segment() for params.superpixels, which must be given, from the map's cells. They merge by
/// superpixel_distance until as many are left as wanted; then refine_outlines moves the outlines. Where cells
/// are few, squares of half the spacing cut them first, so that only the pixels limit the number. Parameters
/// and sizes are checked by segment().
Segmentation superpixels(const Level& level, const Cells& cells, const FeatureImage& image,
                         const SegmentParams& params, const Progress& progress);

}  // namespace imgmesh
