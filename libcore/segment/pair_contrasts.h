// How much the image changes between neighbouring pixels, seen at several sizes: the evidence for a
// contour.
#pragma once

#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// The spread that colours have without any meaning: noise, shading, compression [L*u*v*]. What a texture
/// spreads beyond it counts against a contrast of means. Chosen on photographs, docs/decisions/0009-segmentation.md.
inline constexpr double kPlainSpread = 6.0;

/// Bhattacharyya's distance of two colour populations with independent channels, each a normal distribution
/// of that mean and variance (plus kPlainSpread^2): grows with the difference of means as far as it stands
/// out from the spreads, and with the ratio of spreads. 0 for equal ones.
double population_distance(const Vec3d& mean_a, const Vec3d& variance_a, const Vec3d& mean_b,
                           const Vec3d& variance_b);

/// A population distance as the L*u*v* distance of two plain colours that are as far apart: for populations
/// without spread of their own it is the distance of their means.
double color_equivalent(double population_distance);

/// The contrast of every pair of neighbours in different cells: the population distances of the two squares
/// of (2r+1)^2 pixels that meet between them, as far as they are inside the mask, mapped to 1 - exp(-d), mean
/// over r = 2, 4 and 8. In [0, 1). Same result for any number of threads.
PairContrasts pair_contrasts(const FeatureImage& picture, const Cells& cells);

}  // namespace imgmesh
