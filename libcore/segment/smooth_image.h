// Edge-preserving smoothing: an image without what is weaker than the contours of its segmentation.
#pragma once

#include "libcore/base/progress.h"
#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Differences up to this disappear by default [L*u*v*]. It removes the noise of a standard deviation of 10
/// of 255 (docs/decisions/0037-smoothing.md).
inline constexpr double kUsualStrength = 8;

/// The largest strength that changes anything: no two colours of a display are further apart.
inline constexpr double kMostStrength = 1000;

/// Smooths an image inside the regions of its segmentation, and keeps the borders between them. Differences
/// and contours weaker than about `strength` vanish; of those three times as strong nothing is lost. A ramp
/// stays a ramp, and what lies on one side of a strong contour never mixes with the other side.
///
/// level     of a container; its cells and their merges are the borders
/// features  what segment() measures: L*u*v* of the image or of the level (segment.h)
/// image     to smooth: R, G, B or Y, perhaps A, of the map's size
/// strength  [L*u*v*]; 0 leaves the image as it is
/// return    R, G, B in the image's colour space and sample type, within [0, 1] unless that is linear, there
///           at least 0; A if the image has it or the map has pixels outside. A is that of the image, 0
///           outside. Pixels outside keep their colour and give none; others give in proportion to alpha.
///
/// Takes O(pixels) time beside that of segment(), about 0.4 s for 768 x 512 pixels on one core. The result is
/// the same for any number of threads. Throws Error(kBadArgument) for a strength below 0 or above
/// kMostStrength and for another size; Error(kUnsupported) for an image without colour and as segment() does.
Image smooth_image(const Level& level, const FeatureImage& features, const Image& image, double strength,
                   const Progress& progress = {});

}  // namespace imgmesh
