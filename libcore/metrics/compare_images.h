// Compares two images pixel by pixel.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/metrics/distribution.h"

namespace imgmesh {

/// The bins are fixed, so that histograms of different pairs can be compared.
inline constexpr Bins kLuvErrorBins{0, 20, 20};
inline constexpr Bins kCiede2000Bins{0, 10, 20};

/// The differences of two images.
struct ImageDifference {
    std::int64_t pixels = 0;       ///< pixels compared: not wholly transparent (alpha 0) in either image
    std::int64_t in_one_only = 0;  ///< pixels that are wholly transparent in one of the two
    /// Colour space of RGB figures and SSIM: that of both images if equal and not linear, else sRGB.
    ColorSpace color_space = ColorSpace::kSrgb;

    double rms_luv = 0;  ///< root mean square Euclidean distance in L*u*v* per pixel
    double max_luv = 0;
    double rms_rgb = 0;  ///< over R, G and B of all pixels, 0..1
    double max_rgb = 0;  ///< largest difference in any of R, G, B
    double psnr = 0;     ///< 20 log10(1 / rms_rgb) [dB]; infinite when equal
    double ssim = 0;     ///< of luma 0.299 R + 0.587 G + 0.114 B (Wang et al. 2004); NaN where no window of
                         ///< 11 x 11 pixels fits

    std::vector<float> luv;        ///< size width * height: distance in L*u*v*; NaN where not compared
    std::vector<float> ciede2000;  ///< size width * height: CIEDE2000 (Sharma et al. 2005), likewise
};

/// Compares two images. Grey counts as R = G = B; alpha only decides which pixels are compared. Symmetric in
/// `a` and `b`; all figures are 0 if no pixel is compared. The result is the same for any number of threads.
/// Takes O(pixels) time. Throws Error(kBadArgument) if sizes differ, Error(kUnsupported) for an image without
/// colour.
ImageDifference compare_images(const Image& a, const Image& b);

/// Returns whether the image has R, G and B, or Y.
bool has_color(const Image& image);

}  // namespace imgmesh
