// Scenes for Godot 3 that show an image on a mesh. The same mesh gives the same bytes.
#pragma once

#include <string>

#include "libcore/mesh/disc_part.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// A scene of one Polygon2D for each part, under a Node2D if there are several: polygon and uv in pixels from
/// the image's top-left corner, y down, vertices inside counted as internal, a polygon for each triangle.
/// Vertices are kept inside the image.
///
/// parts  disc_parts(mesh) of libcore/mesh/disc_parts.h
/// image  the image file, relative to the scene
/// name   of the scene's root
/// Throws Error(kBadArgument) for a name with a control character.
std::string godot_polygons(const BaseMesh& mesh, const std::vector<DiscPart>& parts, const SourceInfo& source,
                           const std::string& image, const std::string& name);

/// A scene of one MeshInstance2D with an ArrayMesh: places in pixels as in godot_polygons(), texture
/// coordinates from (0, 0) to (1, 1), 32-bit floats.
std::string godot_mesh(const BaseMesh& mesh, const SourceInfo& source, const std::string& image,
                       const std::string& name);

}  // namespace imgmesh
