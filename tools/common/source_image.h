// Reads the image that a container was made from.
#pragma once

#include <string>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Reads it. Throws Error(kBadFile) if its size is not that of `source`, which belongs to `container`.
Image read_source_image(const std::string& path, const SourceInfo& source, const std::string& container);

}  // namespace imgmesh
