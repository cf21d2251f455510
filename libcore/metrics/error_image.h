// Draws errors as an image.
#pragma once

#include <span>

#include "libcore/image/image.h"

namespace imgmesh {

/// Returns the L*u*v* colour of a share of the error scale, 0 to 1 (clamped): black, blue, red, orange,
/// white. L* is 100 times the share, so equal steps of error are equal steps of lightness.
Vec3f error_color(double share);

/// Draws one value a pixel (width * height, rows from top to bottom) as an 8-bit sRGB image. 0 is black,
/// `range` and more is white. NaN (no value) is a dull green, which the scale does not have. range > 0.
/// ImageDifference::visible holds such values.
Image error_image(std::span<const float> error, int width, int height, double range);

}  // namespace imgmesh
