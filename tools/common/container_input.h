// Checks of containers that the tools read.
#pragma once

#include <string>

#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Returns whether a file name is that of a container: .glb or .gltf. Of standard input, the content decides.
bool is_container(const std::string& path);

/// Throws Error(kBadArgument) if `option` names a level that the container `path` does not have.
void check_level(const std::string& option, std::int64_t level, const std::string& path,
                 const MeshImage& mesh_image);

}  // namespace imgmesh
