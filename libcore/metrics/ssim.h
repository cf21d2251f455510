// SSIM, a measure of the structural similarity of two images.
#pragma once

#include <span>

namespace imgmesh {

/// The constants of Wang, Bovik, Sheikh, Simoncelli, "Image quality assessment: from error visibility to
/// structural similarity", IEEE Transactions on Image Processing 13(4), 2004, sec. III, for samples of 0..1.
inline constexpr int kSsimWindow = 11;          ///< pixels a side
inline constexpr double kSsimSigma = 1.5;       ///< of the window's Gaussian weights, which sum to 1 [pixels]
inline constexpr double kSsimC1 = 0.01 * 0.01;  ///< (K1 L)^2 with K1 = 0.01, L = 1
inline constexpr double kSsimC2 = 0.03 * 0.03;  ///< (K2 L)^2 with K2 = 0.03, L = 1

/// Returns the mean SSIM of two grey images of width * height samples in 0..1, rows from top to bottom. This
/// is the mean of eq. (13) over all positions of the window inside the image, without downsampling. Windows
/// with a sample that is NaN in either image are left out. The result is NaN if no window is left, as in an
/// image smaller than the window, and 1 for equal images. It is the same for any number of threads.
double mean_ssim(std::span<const float> a, std::span<const float> b, int width, int height);

}  // namespace imgmesh
