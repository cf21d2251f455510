// Labels as a TIFF of 32-bit integers.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// Returns the bytes of a grey TIFF with one unsigned 32-bit label a pixel, width * height of them, packed by
/// deflate. GDAL's tag names kNone as the value that is no data. Same bytes for the same labels.
std::vector<std::uint8_t> tiff_from_labels(int width, int height, std::span<const Id> labels);

}  // namespace imgmesh
