// How far two neighbouring regions are apart: what decides which of them become one.
#pragma once

#include "libcore/segment/merge_regions.h"

namespace imgmesh {

/// The paper's (sec. 4.1): the distance of the regions' colours in L*u*v*, each the mean of its pixels'
/// weighted by the least of their three weights.
RegionDistance paper_distance();

/// Colours and texture of the regions, contrast along their border, size and shape, in L*u*v* units:
///
///     color_equivalent(-ln(1 - m)) * (4 h / pixels)^0.2 * (l / sqrt(2 s))^-0.2
///     m = 0.7 (mean contrast of the border) + 0.3 (1 - exp(-population distance of the regions))
///
/// with h = a b / (a + b) of the regions' pixels a and b, s the lesser of them, and l the border's length.
/// `pixels` is the number of pixels in all. Two plain halves of a square image are as far apart as their
/// colours are; small regions and long borders count less. Figures: docs/decisions/0009-segmentation.md.
RegionDistance contour_distance(double pixels);

/// Ward's criterion: what a merge adds to the sum of squares about the regions' means, of colours and of
/// places, a place being compactness / spacing times its pixels; as SLIC weighs them (Achanta et al. 2012).
/// compactness in L*u*v* units, spacing [pixels] as of superpixels on a square grid.
RegionDistance superpixel_distance(double compactness, double spacing);

}  // namespace imgmesh
