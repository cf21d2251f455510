// The image that engines put on a mesh.
#pragma once

#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// Returns `image` in 8-bit sRGB, clipped to what a display shows. It has RGB, and with a mask also A, which
/// is 1 inside and 0 outside; the image's own alpha does not count.
///
/// Engines mix neighbouring pixels, and a mesh reaches up to a pixel beyond its mask. So pixels outside have
/// colours too: near the mask those of their neighbours, farther away the mean of all pixels inside.
///
/// mask   empty() for none, else of the image's size.
/// Throws Error(kUnsupported) if the image has neither R, G, B nor Y.
Image texture_image(const Image& image, const Mask& mask);

}  // namespace imgmesh
