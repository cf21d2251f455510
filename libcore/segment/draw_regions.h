// Images of a segmentation.
#pragma once

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

/// Draws each region in one L*u*v* colour, for example its mean. The result has RGB in the source's colour
/// space and sample type. If some pixel is outside the mask, it also has A, which is 0 there.
///
/// colors  one for each region, such as RegionFacts::color
Image draw_flat(const LabelImage& labels, const std::vector<Vec3f>& colors, const SourceInfo& source);

/// Draws `image` (L*u*v*) with lines one pixel wide along the regions' borders. A line is drawn on pixels
/// whose right or lower neighbour belongs to another region or is outside the mask. The result has the
/// channels of draw_flat().
Image draw_outlines(const LabelImage& labels, const FeatureImage& image, const SourceInfo& source);

}  // namespace imgmesh
