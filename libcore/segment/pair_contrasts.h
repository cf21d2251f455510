// How much the image changes between neighbouring pixels, measured at several sizes: the evidence for a
// contour.
#pragma once

#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// The standard deviation of uniform colours, from noise, shading and compression [L*u*v*]. Texture is above
/// it and lowers contrasts. Chosen on photographs: docs/decisions/0009-segmentation.md.
inline constexpr double kUniformDeviation = 6.0;

/// Bhattacharyya's distance of two colour populations. Each is a normal distribution with independent
/// channels, of the given mean and variance plus kUniformDeviation^2. The distance grows with the difference
/// of means relative to the deviations, and with the ratio of deviations. It is 0 for equal populations.
double population_distance(const Vec3d& mean_a, const Vec3d& variance_a, const Vec3d& mean_b,
                           const Vec3d& variance_b);

/// Converts a population distance to the L*u*v* distance of two uniform colours that are equally far apart.
/// For populations without deviation of their own this is the distance of their means.
double color_equivalent(double population_distance);

/// Returns 1 - exp(-population_distance) of two sets of pixels, in [0, 1). Each is given by seven sums: the
/// number of its pixels, above 0, their colours and the squares of these.
float sums_contrast(const float* a, const float* b);

/// Returns the contrast of every pair of neighbours in different cells: 1 - exp(-d), mean over r = 2, 4, 8. d
/// is the population distance of the two squares of (2r+1)^2 pixels that meet between them, as far as they
/// are inside the mask. In [0, 1). The result is the same for any number of threads.
PairContrasts pair_contrasts(const FeatureImage& image, const Grid<Id>& cells);

/// pair_contrasts() looks at pixels up to this many columns or rows away from a pair's nearer one.
inline constexpr int kSquareReach = 16;

}  // namespace imgmesh
