// The second stage of segmentation for a picture in parts.
#pragma once

#include "libcore/segment/contours/small_image.h"
#include "libcore/segment/region_graph.h"
#include "libcore/segment/segment_parts.h"

namespace imgmesh {

/// Smooths the outlines of `count` regions by discs of `radius`, and gives every connected part of them a
/// number of its own in `labels`, by its first pixel. Returns the graph of these parts, with contrasts
/// measured as contour_contrasts() does. Reads the picture once more.
RegionGraph contour_graph(const PictureParts& picture, PartLabels& labels, std::size_t count, int radius,
                          const SmallImage& small, const Progress& progress);

}  // namespace imgmesh
