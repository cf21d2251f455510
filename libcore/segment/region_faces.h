// The regions of a base mesh's faces.
#pragma once

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

/// The region of every face: the one that most of its patch's pixels belong to, of several the lowest. A face
/// without pixels follows a neighbour across an edge, the nearest that has some; kNone where there is none.
/// A region all of whose pixels are few of their patches has no face.
std::vector<Id> region_of_faces(const BaseMesh& mesh, const PixelMap& map, const LabelImage& labels);

}  // namespace imgmesh
