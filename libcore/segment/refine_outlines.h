// Outlines of regions, moved pixel by pixel.
#pragma once

#include <cstdint>

#include "libcore/segment/labels.h"

namespace imgmesh {

struct OutlineParams {
    double compactness = 4.0;   ///< this L*u*v* distance counts as much as one spacing; >= 0
    double spacing = 1.0;       ///< of the regions on a square grid [pixels]; > 0
    std::int64_t min_size = 1;  ///< no region of this many pixels or more shrinks below it
};

/// Moves single pixels between neighbouring regions, as long as that lowers the energy
///
///     sum over pixels  |colour - mean colour of its region|^2 + c^2 |place - mean place|^2 / spacing^2
///     + c^2 times the length of the outlines,    c = compactness
///
/// which is the sum of squares behind Ward's criterion, with a price on outlines. The length counts pairs
/// of 4-neighbours in different regions as 1 and diagonal pairs as sqrt(1/2). Every region stays 4-connected
/// and keeps a pixel, so their number stays; the numbers themselves follow the new first pixels.
///
/// The image is L*u*v*, of the labels' size. Visits the pixels a fixed number of times, in O(pixels) time.
/// After the topology-preserving moves of Yao et al., "Real-Time Coarse-to-fine Topologically Preserving
/// Segmentation", CVPR 2015. Figures: docs/decisions/0010-superpixels.md.
void refine_outlines(LabelImage& labels, const FeatureImage& image, const OutlineParams& params);

}  // namespace imgmesh
