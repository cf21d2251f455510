// Draws an image whose pixels have moved, and the map from the drawing back to the image.
#pragma once

#include "libcore/image/image.h"
#include "libcore/warp/displacement.h"

namespace imgmesh {

/// Size of a drawing [pixels]; 0 means the image's. Pixel i of a side of n pixels shows the place (i + 0.5) N
/// / n - 0.5 on the image's side of N pixels, before pixels move.
struct OutputSize {
    int width = 0;
    int height = 0;
};

/// Draws the image with every pixel at its own place plus its move, by forward mapping of the pixel grid. The
/// cell between four pixels is two triangles, so nothing tears. It is cut from top left to bottom right, or
/// the other way if only that avoids a fold. A point of the drawing shows the point (x, y) of its cell,
/// interpolated bilinearly between the four pixels, samples as encoded, all channels alike.
///
/// - Shrinking: let a step of one output pixel cover n source pixels to the right and m down, both rounded
///   and at least 1. Then the pixel is the mean of n x m points, evenly spread over its footprint. A
///   footprint longer than 64 is sampled 64 times.
/// - Folds: of several triangles over one point, those with four drawn pixels win over the boundary's, then
///   those not turned over, then the later row, then the later column.
/// - Alpha is a weight in all means. The area more than half a pixel outside the outermost centres is
///   transparent, and so are pixels outside the mask. Sides that move get the share of the pixel that the
///   image covers. The drawing has the image's channels, and also A if something is transparent.
/// - If the centre of an output pixel is that of a source pixel in an unstretched cell, it is that pixel to
///   the bit. Without any move the drawing is the image; outside the mask it keeps its colours but is
///   transparent. If all pixels move by the same whole numbers, the drawing is the image shifted.
///
/// image  of the field's size
///
/// The result is the same for any number of threads. Takes O(pixels of the image + samples of the drawing)
/// time. Throws Error(kBadFile) for an image of another size, Error(kBadArgument) for an output size below 1,
/// above 2^28 pixels, or above 65535 on a side.
Image warp_image(const Image& image, const DisplacementField& field, const OutputSize& size = {});

/// Returns the image's own alpha, of size width * height, or empty if it has none.
std::vector<float> alpha_of(const Image& image);

/// Which point of the image each pixel of the drawing shows.
struct InverseMap : GridSize {
    std::vector<Vec2f> source;    ///< size width * height [pixels of the image]; 0 where nothing is shown
    std::vector<float> coverage;  ///< share of the pixel that the image covers; 0 outside the mask
};

/// Returns the points of the image that the drawing of warp_image() shows. `alpha` is alpha_of() the image.
/// Throws as warp_image() does.
InverseMap inverse_map(const DisplacementField& field, std::vector<float> alpha, const OutputSize& size = {});

}  // namespace imgmesh
