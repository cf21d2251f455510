// The image that a container was made from.
#pragma once

#include <string>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Reads it. Throws Error(kBadFile) where its size is not that of `source`, which is `container`'s.
Image read_source_image(const std::string& path, const SourceInfo& source, const std::string& container);

}  // namespace imgmesh
