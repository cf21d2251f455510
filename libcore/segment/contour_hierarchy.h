// The hierarchy of regions by the contours between them.
#pragma once

#include <cstdint>

#include "libcore/base/progress.h"
#include "libcore/segment/cells.h"
#include "libcore/segment/hierarchy.h"
#include "libcore/segment/segment.h"

namespace imgmesh {

/// So many regions go on from the first stage to the second. People draw a few dozen, and 1000 or 2500 do as
/// well.
inline constexpr std::size_t kFirstRegions = 1500;

/// Returns the radius of the discs that smooth the outlines of an image with so many pixels inside its mask
/// (majority.h): 4 in images of kMeasuredPixels and more; it shrinks with smaller images, where a pixel
/// matters more.
int smoothing_radius(double pixels);

/// Turns distances into heights; see contour_hierarchy().
void scale_heights(Hierarchy& hierarchy);

/// Cells and all their merges.
struct CellHierarchy {
    Cells cells;
    Hierarchy hierarchy;
};

/// Returns about how much memory measuring the contours of the second stage takes, for an image of that size,
/// beside the image, its map and what the first stage has had [bytes]. It grows with the image only up to
/// 0.35 million pixels; larger ones are measured at a smaller size.
double contour_memory(const GridSize& size);

/// Merges the patches of a map, closest first, by contour_distance, in two stages. First, cells merge by the
/// contrasts of squares (pair_contrasts.h) until 1500 regions are left. Their outlines are smoothed, the
/// contrast along them is measured with texture and direction (contours/), and merging goes on. The cells of
/// the result are the patches, cut along the smoothed outlines; inside a smoothed region they merge first.
///
/// The heights are color_equivalent(-ln(1 - d)) of a distance d: for weak contrasts this is a distance of
/// colours [L*u*v*]; where d is near 1, it grows without much meaning. Each image's distances are first
/// divided by the square root of what they are like at 8 to 64 regions, so that one threshold suits images of
/// strong and of weak contrast; the factor lies between 1/2 and 2.
///
/// kFast ends with the first stage. Figures: docs/decisions/0036-contours-with-texture.md.
CellHierarchy contour_hierarchy(const PixelMap& map, const FeatureImage& image, SegmentQuality quality,
                                std::int64_t min_size, const Progress& progress);

}  // namespace imgmesh
