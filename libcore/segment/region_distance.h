// The distances between neighbouring regions that decide which of them merge.
#pragma once

#include "libcore/segment/merge_regions.h"

namespace imgmesh {

/// The paper's distance (sec. 4.1): that of the regions' colours in L*u*v*. A region's colour is the mean of
/// its pixels' colours, each weighted by the smallest of the pixel's three weights.
RegionDistance paper_distance();

/// Combines colours and texture of the regions, contrast along their border, size and shape:
///
///     m * (4 h / pixels)^0.2 * (l / sqrt(2 s))^-0.2
///     m = 0.7 (mean contrast of the border) + 0.3 (1 - exp(-population distance of the regions))
///
/// with h = a b / (a + b) for regions of a and b pixels, s the smaller of a and b, and l the border's length.
/// `pixels` is the number of pixels in all. Two halves of a square image have the distance m, which is in
/// [0, 1]. Small regions and long borders count less. Figures: docs/decisions/0036-contours-with-texture.md.
RegionDistance contour_distance(double pixels);

/// Ward's criterion: what a merge adds to the sum of squares about the regions' means, of colours and of
/// places times compactness / spacing, as in SLIC (Achanta et al. 2012). Of colours more than 5 apart the
/// distance counts instead of its square, as in Huber's loss. `compactness` is in L*u*v* units, `spacing` is
/// that of superpixels on a square grid [pixels]. Figures: docs/decisions/0010-superpixels.md.
RegionDistance superpixel_distance(double compactness, double spacing);

}  // namespace imgmesh
