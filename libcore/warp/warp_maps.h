// Warps as images that compositing programs read. write_image() writes both as EXR.
#pragma once

#include "libcore/image/image.h"
#include "libcore/warp/warp_image.h"

namespace imgmesh {

/// Returns the channels displacement.x and displacement.y: how far each pixel of the image moves [pixels, x
/// right, y down], 0 outside the mask. No program takes these names for colour.
Image forward_map_image(const DisplacementField& field);

/// Returns the channels R, G, A of an STMap. For each pixel of the drawing that shows the point (x, y) of the
/// W x H image, R = (x + 0.5) / W and G = 1 - (y + 0.5) / H. So both run from 0 to 1 across the image, G
/// upwards, and the centre of the bottom left pixel is (0.5 / W, 0.5 / H). A is the share of the pixel that
/// the image covers; where it is 0, R and G are 0.
Image st_map_image(const InverseMap& map, int image_width, int image_height);

}  // namespace imgmesh
