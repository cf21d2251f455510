// Colours that distinguish the patches of a pixel map.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Returns one L*u*v* colour per face: the mean colour of its patch, tinted with one of eight hues so that
/// patches that touch (4-neighbours) differ clearly. It depends only on the mesh and the map.
std::vector<Vec3f> patch_colors(const BaseMesh& mesh, const PixelMap& map);

}  // namespace imgmesh
