// The visit map as a grey image (paper fig. 2).
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// L* of every pixel, from 100 for the 2 % least visited to 0 for the 2 % most visited, linear in the number
/// of visits; 100 where nearly all are visited alike. Pixels outside the mask take no part and get 0. Throws
/// Error(kUnsupported) where there are no visits.
std::vector<float> visit_lightness(const MeshImage& mesh_image);

}  // namespace imgmesh
