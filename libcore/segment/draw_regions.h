// Images of a segmentation.
#pragma once

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

/// Each region in one colour, L*u*v*, e.g. its mean. RGB in the source's colour space and sample type, and A,
/// 0 outside the mask, where some pixel is.
Image draw_flat(const LabelImage& labels, const std::vector<Vec3f>& colors, const SourceInfo& source);

/// `picture` (L*u*v*) with a line one pixel wide along the regions' borders: on pixels whose right or lower
/// neighbour is of another region, or outside the mask.
/// Shape as of draw_flat.
Image draw_outlines(const LabelImage& labels, const FeatureImage& picture, const SourceInfo& source);

}  // namespace imgmesh
