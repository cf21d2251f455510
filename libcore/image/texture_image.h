// An image as engines put it on a mesh.
#pragma once

#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// `image` in 8-bit sRGB, clipped to what a display shows: RGB, and with a mask A, which is 1 inside and 0
/// outside, whatever alpha the image has.
///
/// Engines mix neighbouring pixels, and a mesh reaches up to a pixel beyond its mask, so pixels outside have
/// colours too: near the mask those of their neighbours, else the mean of all inside.
///
/// mask   empty() for none, else of the image's size.
/// Throws Error(kUnsupported) where the image has neither R, G, B nor Y.
Image texture_image(const Image& image, const Mask& mask);

}  // namespace imgmesh
