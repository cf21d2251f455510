// Images as pictures of 8 bits, and back.
#pragma once

#include "libcore/coding/bitmap.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// Returns the colours of an image in 8-bit sRGB, clipped to what a display shows and rounded. It has as few
/// channels as that takes: an image whose colours are all grey becomes grey, and alpha that is 255 everywhere
/// is left out. Takes 16 bytes of memory a pixel beside the result. Throws Error(kUnsupported) for an image
/// without colour.
Bitmap bitmap_from_image(const Image& image);

/// Returns a picture as an image: Y, Y A, R G B or R G B A.
Image image_from_bitmap(const Bitmap& picture);

}  // namespace imgmesh
