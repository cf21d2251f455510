// Codes: one small number for each pixel, so that the pixels of a disc are compared by counting.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/segment/contours/small_image.h"

namespace imgmesh {

/// Codes are 0 .. kCodes - 1.
inline constexpr int kCodes = 32;

/// The code of every pixel.
using Codes = Grid<std::uint8_t>;

/// Values of one kind for all pixels, row by row.
using Plane = std::vector<float>;

/// Learns kCodes centres from the pixels inside the mask and returns each pixel's nearest, the first of
/// equal ones: k-means++ (Arthur and Vassilvitskii 2007) on at most 8000 pixels spread over the image, with
/// fixed random numbers. Pixels outside get a code as well. The result is the same for any number of threads.
///
/// planes  at least one, each of the mask's size; every pixel is a point with one coordinate from each
Codes cluster(const std::vector<Plane>& planes, const Grid<std::uint8_t>& inside);

/// Differences that nobody sees, such as the rounding of a reconstruction, are no texture: colours are
/// rounded to this step before they are clustered [L*u*v*], and the answers of filters to that of L* / 100.
inline constexpr float kColorStep = 1.0f / 16;

/// Returns the multiple of `step` nearest to a value.
float rounded(float value, float step);

/// Textons (Malik et al. 2001): what the image looks like within some pixels. Clusters of the lightness as
/// seen by 17 filters: first and second derivatives of Gaussians, three times as long as wide, in eight
/// directions, and the difference of two round ones.
Codes textons(const SmallImage& image);

/// The image's own palette: clusters of its colours.
Codes palette(const SmallImage& image);

}  // namespace imgmesh
