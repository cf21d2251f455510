// Base meshes in text formats of other programs. The same mesh gives the same bytes. All take O(vertices +
// faces) time. A mesh with outer_positions() covers its pixels to their outer edge.
#pragma once

#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// PLY, ASCII: vertices at (x, -y, 0) [pixels] with sRGB colours of 8 bits, faces as lists. Throws
/// Error(kUnsupported) for a mesh without colour.
std::string ply_from_mesh(const BaseMesh& mesh);

/// Wavefront OBJ: vertices at (x, -y, 0) [pixels] with sRGB colours in [0, 1] after the position, texture
/// coordinates with v up, faces. Throws Error(kUnsupported) for a mesh without colour.
std::string obj_from_mesh(const BaseMesh& mesh, const SourceInfo& source);

/// TexturePacker's JSON with polygon outlines, as Pixi reads it: one frame, the whole image `image`, with
/// `vertices` and `verticesUV` in pixels from the image's top-left corner and `triangles`. Vertices are kept
/// inside the image.
std::string sprite_json_from_mesh(const BaseMesh& mesh, const SourceInfo& source, const std::string& image,
                                  const std::string& generator);

}  // namespace imgmesh
