// A level's mesh in the words of other programs. All as text, the same bytes for the same mesh.
#pragma once

#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// PLY, ASCII: vertices at (x, -y, 0) [pixels] with sRGB colours of 8 bits, faces as lists. Throws
/// Error(kUnsupported) for a mesh without colour, as the next.
std::string ply_from_mesh(const BaseMesh& mesh);

/// Wavefront OBJ: vertices at (x, -y, 0) [pixels] with sRGB colours in [0, 1] after the position, texture
/// coordinates with v up, faces.
std::string obj_from_mesh(const BaseMesh& mesh, const SourceInfo& source);

/// The JSON of TexturePacker with polygon outlines, as Pixi reads it: one frame, the whole image `image`,
/// with `vertices` and `verticesUV` in pixels from the image's top-left corner and `triangles`. A vertex on
/// a side of the image lies on the outermost pixels' outer side, so that the sprite is as large as the
/// image.
std::string sprite_json_from_mesh(const BaseMesh& mesh, const SourceInfo& source, const std::string& image,
                                  const std::string& generator);

}  // namespace imgmesh
