// Two images against each other, pixel by pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/metrics/distribution.h"

namespace imgmesh {

/// Fixed bins for the errors of pixels, so that histograms of different pairs can stand side by side.
inline constexpr Bins kLuvErrorBins{0, 20, 20};
inline constexpr Bins kCiede2000Bins{0, 10, 20};

struct ImageDifference {
    std::int64_t pixels = 0;       ///< compared: not wholly transparent (alpha 0) in either image
    std::int64_t in_one_only = 0;  ///< pixels that are wholly transparent in one of the two
    /// Of the RGB figures and SSIM: that of both images where they share one that is not linear, else sRGB.
    ColorSpace color_space = ColorSpace::kSrgb;

    double rms_luv = 0;  ///< root mean square Euclidean distance in L*u*v* per pixel
    double max_luv = 0;
    double rms_rgb = 0;  ///< over R, G and B of all pixels, 0..1
    double max_rgb = 0;  ///< largest difference in any of R, G, B
    double psnr = 0;     ///< 20 log10(1 / rms_rgb) [dB]; infinite when equal
    double ssim = 0;     ///< mean_ssim() of luma 0.299 R + 0.587 G + 0.114 B; NaN where no window fits

    std::vector<float> luv;        ///< size width * height: distance in L*u*v*; NaN where not compared
    std::vector<float> ciede2000;  ///< size width * height: ciede2000(); NaN where not compared
};

/// Grey counts as R = G = B; alpha only tells which pixels are compared. Symmetric in `a` and `b`; the
/// figures are 0 where no pixel is compared. Same result for any number of threads. Throws
/// Error(kBadArgument) where sizes differ, Error(kUnsupported) for an image without colour.
ImageDifference compare_images(const Image& a, const Image& b);

/// Whether the image has R, G and B, or Y.
bool has_color(const Image& image);

}  // namespace imgmesh
