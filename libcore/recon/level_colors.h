// What the raster and the SVG drawings share.
#pragma once

#include <vector>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Level `level_index`. Throws Error(kBadArgument) where it is not there.
const Level& checked_level(const MeshImage& mesh_image, int level_index);
/// The same; throws Error(kUnsupported) for a mesh without colour.
const Level& level_to_draw(const MeshImage& mesh_image, int level_index);

/// The mean of the three corners' colours of every face, L*u*v*. mesh.channels >= 3.
std::vector<Vec3f> face_means(const BaseMesh& mesh);

}  // namespace imgmesh
