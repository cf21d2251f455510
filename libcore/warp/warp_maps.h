// A warp as images that compositors read.
#pragma once

#include "libcore/image/image.h"
#include "libcore/warp/warp_image.h"

namespace imgmesh {

/// Channels displacement.x, displacement.y: how far each pixel of the image moves [pixels, x right, y
/// down]; 0 outside the mask. Names that nothing takes for colour.
Image forward_map_image(const DisplacementField& field);

/// Channels R, G, A as an STMap: R = (x + 0.5) / W and G = 1 - (y + 0.5) / H of the point (x, y) of the
/// image, W x H pixels, that each pixel of the drawing shows. So both run from 0 to 1 over the image from
/// side to side, G upwards, and the centre of the bottom left pixel is (0.5 / W, 0.5 / H). A: the share of
/// the pixel that the image covers; where it is 0, R and G are 0.
Image st_map_image(const InverseMap& map, int image_width, int image_height);

}  // namespace imgmesh
