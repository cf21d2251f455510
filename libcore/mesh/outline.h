// The outline of a mask as polygons, and with fewer vertices: what a sprite's mesh is made from.
#pragma once

#include <vector>

#include "libcore/image/mask.h"
#include "libcore/mesh/loop.h"

namespace imgmesh {

/// Returns the polygons along the pixel edges between inside and outside, without vertices on straight edges.
/// Pixels that touch at a corner alone are apart; the polygons then share a point. Takes O(pixels) time.
std::vector<Loop> mask_contours(const Mask& mask);

/// Returns the contours of the mask with as few vertices as a greedy search finds, none farther than
/// `tolerance` [pixels] from the mask's, on kPositionStep, within the image and without crossings. With kOut
/// it only ever grows (a progressive hull), and every place in it is at most `tolerance` from a pixel inside.
/// A slope of stairs takes up to 0.71 of it. With kBoth every vertex of the contour is at most `tolerance`
/// from the edge that stands for it. Holes of which no place is farther than `tolerance` from the mask are
/// filled, others stay.
///
/// tolerance  0 or more
/// Throws Error(kUnsupported) for a mask without a pixel inside. Takes about O(n^2) time for n corners of
/// pixels.
std::vector<Loop> simplified_outline(const Mask& mask, double tolerance, OutlineSide side);

}  // namespace imgmesh
