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
    /// What one sees of the two: the same over all pixels that are not wholly transparent in both, laid over
    /// black or over white, whichever differs more. Alpha mixes encoded colours, as browsers and image
    /// programs do. Equal to rms_luv and max_luv where all pixels are opaque.
    double rms_visible = 0;
    double max_visible = 0;
    double rms_alpha = 0;  ///< of alpha over all pixels; an image without alpha is opaque
    double max_alpha = 0;
    double rms_rgb = 0;  ///< over R, G and B of all pixels, 0..1
    double max_rgb = 0;  ///< largest difference in any of R, G, B
    double psnr = 0;     ///< 20 log10(1 / rms_rgb) [dB]; infinite when equal
    double ssim = 0;     ///< of luma 0.299 R + 0.587 G + 0.114 B (Wang et al. 2004); NaN where no window of
                         ///< 11 x 11 pixels fits

    std::vector<float> luv;        ///< size width * height: distance in L*u*v*; NaN where not compared
    std::vector<float> ciede2000;  ///< size width * height: CIEDE2000 (Sharma et al. 2005), likewise
    std::vector<float> visible;    ///< size width * height: of rms_visible; NaN where both are transparent
};

/// Compares two images. Grey counts as R = G = B. For the figures of colour, alpha only decides which pixels
/// are compared; they are NaN if none is. Symmetric in `a` and `b`. The result is the same for any number of
/// threads. Takes O(pixels) time. Throws Error(kBadArgument) if sizes differ, Error(kUnsupported) for an
/// image without colour.
ImageDifference compare_images(const Image& a, const Image& b);

/// Returns whether the image has R, G and B, or Y.
bool has_color(const Image& image);

}  // namespace imgmesh
