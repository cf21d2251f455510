// The visit map as a grey image (paper fig. 2).
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns L* of every pixel: 100 for the 2 % with the fewest visits, 0 for the 2 % with the most, linear in
/// the number of visits between. If nearly all pixels have the same number, L* is 100. Pixels outside the
/// mask do not count and get 0. Throws Error(kUnsupported) if there are no visits.
std::vector<float> visit_lightness(const MeshImage& mesh_image);

}  // namespace imgmesh
