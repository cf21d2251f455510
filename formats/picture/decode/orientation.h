// How an image stands: EXIF's orientation. Internal to this room.
#pragma once

#include "libcore/image/image.h"

namespace imgmesh {

/// Where a displayed pixel is stored: first the axes are exchanged, then each may be reversed.
struct Orientation {
    bool exchange = false, backwards_x = false, backwards_y = false;

    bool operator==(const Orientation&) const = default;
};

/// Returns that of a tag's number, 1 to 8; other numbers say nothing (EXIF 2.3, tag Orientation).
Orientation orientation_of(int number);

/// Returns where a rectangle of the displayed image lies in the stored one of `width` x `height` pixels.
PixelRect stored_rect(const PixelRect& displayed, const Orientation& orientation, int width, int height);

}  // namespace imgmesh
