// Wavefront OBJ with a material that shows an image. The same mesh gives the same bytes.
#pragma once

#include <span>
#include <string>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The mesh with a texture instead of colours: vertices at (x, -y, 0) [pixels], texture coordinates with v
/// up, faces, all with the one material of mtl_of_texture() in the file `mtl` of the same folder.
///
/// coords  for each vertex its place in the image, from (0, 0), the top-left corner, to (1, 1)
/// Throws Error(kBadArgument) for a name with a control character, which no line can hold.
std::string textured_obj(const BaseMesh& mesh, std::span<const Vec2f> coords, const std::string& mtl);

/// The material library: one unlit material with the image file `image` of the same folder, which is also its
/// transparency if it is `transparent`. Throws as textured_obj() does.
std::string mtl_of_texture(const std::string& image, bool transparent);

}  // namespace imgmesh
