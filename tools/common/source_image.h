// Reads the image that a container was made from.
#pragma once

#include <string>
#include <vector>

#include "formats/picture/image_io.h"
#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Reads it as read_with_warnings() does. Throws Error(kBadFile) if its size is not that of `source`, which
/// belongs to `container`.
Image read_source_image(const std::string& path, const SourceInfo& source, const std::string& container,
                        const ReadImageOptions& options, std::vector<std::string>& warnings);

}  // namespace imgmesh
