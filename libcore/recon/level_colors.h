// What raster drawings and SVG drawings share.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns level `level_index`. Throws Error(kBadArgument) if it does not exist.
const Level& checked_level(const MeshImage& mesh_image, int level_index);
/// The same. Throws Error(kUnsupported) for a mesh without colour.
const Level& level_to_draw(const MeshImage& mesh_image, int level_index);

/// Returns the feature that is the alpha of a mesh with colour, or -1.
int alpha_feature(const SourceInfo& source);

/// Returns the mean colour of every face's three corners, L*u*v*. mesh.channels >= 3.
std::vector<Vec3f> face_means(const BaseMesh& mesh);

/// Returns an empty image to draw on: R, G, B, and A if `clear`, in the source's sample type and colour
/// space, or for HDR meshes in linear RGB.
Image drawing_canvas(const SourceInfo& source, int width, int height, bool clear);

}  // namespace imgmesh
