// The ultrametric contour map: one image that holds the segmentations for all thresholds.
#pragma once

#include <vector>

#include "libcore/segment/cells.h"
#include "libcore/segment/hierarchy.h"

namespace imgmesh {

/// Heights of contours on a grid of twice the image's resolution, as Arbelaez et al. (TPAMI 2011) store
/// them: (2W+1) x (2H+1) values. Pixel (x, y) is at (2x+1, 2y+1), the value between two 4-neighbours
/// halfway.
///
/// The value between two pixels is the threshold at which their regions become one: for every t > 0 the
/// regions at threshold t are the connected parts of pixels joined across values less than t. The value is
/// infinity between inside and outside of the mask, and 0 at pixels, along the frame, and between outside
/// pixels. Where four pixels meet, it is the largest of the four values around.
struct ContourMap : Grid<float> {
    using Grid::Grid;
};

/// Returns the contour map of an image; `hierarchy` has the merges of `cells`. Takes O(pixels + borders log
/// cells) time.
ContourMap contour_map(const Cells& cells, const Hierarchy& hierarchy);

}  // namespace imgmesh
