// Draws an image whose pixels have moved; and the same as a map from the drawing back to the image.
#pragma once

#include "libcore/image/image.h"
#include "libcore/warp/displacement.h"

namespace imgmesh {

/// Size of a drawing [pixels]; 0: the image's. Pixel i of a side of n shows what lies at
/// (i + 0.5) N / n - 0.5 of the image's side N, before pixels move.
struct OutputSize {
    int width = 0;
    int height = 0;
};

/// The image drawn with every pixel at its own place plus its move, by forward mapping of the pixel grid:
/// the cell between four pixels is two triangles (cut from top left to bottom right, the other way only where
/// that alone avoids a fold), so nothing tears. A point of the drawing shows the point (x, y) of its cell,
/// bilinearly between the four pixels, samples as encoded, all channels alike.
///
/// - Shrinking: where a step of one output pixel to the right goes n source pixels far and one down m, both
///   rounded and at least 1, the pixel is the mean of n x m such points, evenly over its footprint. A
///   footprint longer than 64 is sampled 64 times.
/// - Folds: of several triangles over one point those with four drawn pixels win against the boundary's, then
///   those not turned over, then the later row, then the later column.
/// - Alpha is a weight in all means. The image's sides, half a pixel outside the outermost centres, and
///   pixels outside the mask are clear; sides that move get the share of the pixel that the image covers.
///   The drawing has the image's channels, and A as well where something is clear.
/// - An output pixel whose centre is that of a source pixel in an unstretched cell is that pixel to the bit:
///   without any move the drawing is the image (outside the mask its colours too, clear), and where all
///   pixels move by whole numbers it is the image shifted.
///
/// image  of the field's size. Same result for any number of threads.
/// Throws Error(kBadFile) for an image of another size, Error(kBadArgument) for an output size below 1 or
/// with more than 2^28 pixels or 65535 a side.
Image warp_image(const Image& image, const DisplacementField& field, const OutputSize& size = {});

/// The image's own alpha, size width * height; empty without one.
std::vector<float> alpha_of(const Image& image);

/// Which point of the image each pixel of the drawing shows.
struct InverseMap {
    int width = 0;
    int height = 0;
    std::vector<Vec2f> source;    ///< size width * height [pixels of the image]; 0 where nothing is shown
    std::vector<float> coverage;  ///< share of the pixel that the image covers; 0 outside the mask
};

/// As warp_image() draws it; `alpha` is alpha_of() the image.
InverseMap inverse_map(const DisplacementField& field, std::vector<float> alpha, const OutputSize& size = {});

}  // namespace imgmesh
