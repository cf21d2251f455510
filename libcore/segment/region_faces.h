// The regions of a base mesh's faces.
#pragma once

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

/// Returns the region of every face: the one that most of its patch's pixels belong to, and the lowest of
/// equal ones. A face without pixels takes the region of the nearest neighbour across edges that has some;
/// kNone if there is none. A region has no face if it has the majority in no patch. Takes
/// O(pixels + faces) time.
///
/// map, labels  of one size; `labels` come from a segmentation of this map
std::vector<Id> region_of_faces(const BaseMesh& mesh, const PixelMap& map, const LabelImage& labels);

}  // namespace imgmesh
