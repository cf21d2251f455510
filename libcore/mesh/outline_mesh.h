// A sprite's mesh from the outline of its pixels alone.
#pragma once

#include "libcore/mesh/mesh_image.h"
#include "libcore/mesh/outline.h"

namespace imgmesh {

/// Returns a mesh image of one level whose mesh is the area inside simplified_outline() of the pixels that
/// have a face in level `level_index`: few triangles for an engine that puts the image on them. Its vertices
/// have the features of that level's nearest vertices. Its map is empty, so it can be written only without
/// layers.
///
/// tolerance  how far the outline may lie from the mask [pixels], 0 or more
/// Throws Error(kBadArgument) for a level that does not exist; Error(kUnsupported) if no pixel has a face.
MeshImage outline_mesh_image(const MeshImage& mesh_image, int level_index, double tolerance,
                             OutlineSide side);

}  // namespace imgmesh
