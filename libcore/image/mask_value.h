// What of an image counts if it is a mask.
#pragma once

#include <functional>

#include "libcore/image/image.h"

namespace imgmesh {

/// Returns the function from a pixel's samples to the value that image_mask() compares with the threshold.
/// Throws as image_mask() does.
std::function<float(const float*)> mask_value(const Image& image, float threshold);

/// Returns the largest of these values. Throws as image_mask() does.
float largest_mask_value(const Image& image, float threshold);

}  // namespace imgmesh
