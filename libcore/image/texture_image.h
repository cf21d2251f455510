// The image that engines put on a mesh.
#pragma once

#include "libcore/image/image.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// What a texture has as its alpha.
enum class TextureAlpha {
    kMask,  ///< 1 inside the mask and 0 outside, whatever alpha the image has
    kOwn    ///< inside the mask the image's own, which is 1 if it has none
};

/// Returns `image` in 8-bit sRGB, clipped to what a display shows. It has RGB, and with a mask or an alpha of
/// its own also A.
///
/// Engines mix neighbouring pixels, and a mesh reaches up to a pixel beyond its mask. So pixels outside have
/// colours too: near the mask those of their neighbours, farther away the mean of all pixels inside.
///
/// mask   empty() for none, else of the image's size.
/// Throws Error(kUnsupported) if the image has neither R, G, B nor Y.
Image texture_image(const Image& image, const Mask& mask, TextureAlpha alpha = TextureAlpha::kMask);

}  // namespace imgmesh
