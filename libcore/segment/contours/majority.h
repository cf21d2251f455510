// Smoother outlines of regions.
#pragma once

#include "libcore/base/grid.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

/// Outlines of patches leave an edge by a pixel or two. Gives each pixel the label that most pixels have in
/// the disc of `radius` around it, the lowest of equal ones, its own if that is among them. Pixels outside
/// the mask (kNone) stay and do not vote. Takes O(pixels + pixels near outlines times radius^2) time.
Grid<Id> majority_labels(const LabelImage& labels, int radius);

/// The same, and then every 4-connected part becomes a region.
LabelImage smooth_outlines(const LabelImage& labels, int radius);

}  // namespace imgmesh
