// The ultrametric contour map: one image that holds the segmentations at all thresholds.
#pragma once

#include <vector>

#include "libcore/segment/merge_regions.h"

namespace imgmesh {

/// Heights of contours on a grid of twice the image's resolution, as Arbelaez et al. (TPAMI 2011) store it:
/// (2W+1) x (2H+1) values, pixel (x, y) at (2x+1, 2y+1), what is between two 4-neighbours halfway between
/// them.
///
/// Between two pixels stands the height at which their regions become one, so that for every t > 0 the
/// regions at threshold t are the connected parts of pixels joined where less than t stands between them.
/// Infinity between inside and outside of the mask; 0 at pixels, along the frame, and between outside pixels;
/// where four pixels meet, the largest of the four values around.
struct ContourMap {
    int width = 0;
    int height = 0;
    std::vector<float> values;  ///< size width * height
};

/// O(pixels + borders log cells).
ContourMap contour_map(const Cells& cells, const Hierarchy& hierarchy);

}  // namespace imgmesh
