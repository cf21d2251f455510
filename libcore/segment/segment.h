// Segmentation from end to end: a level of a container and an image in, labelled regions out.
#pragma once

#include <cstdint>
#include <optional>

#include "libcore/base/progress.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

enum class DistanceRule {
    kContour,  ///< contrast along the border, colour, texture, size and shape: contour_distance()
    kPaper     ///< the difference of weighted mean colours: paper_distance()
};

/// Where merging stops. At most one of `segments` and `superpixels`; without them `threshold` counts.
struct SegmentParams {
    DistanceRule distance = DistanceRule::kContour;  ///< not for superpixels, which have their own
    double threshold = 5.0;                          ///< regions closer than this become one [L*u*v*]; > 0
    std::optional<std::int64_t> segments;            ///< this many regions; >= 1
    std::optional<std::int64_t> superpixels;  ///< this many regions of similar size that follow edges; >= 1
    double compactness = 10.0;  ///< of superpixels: that L*u*v* distance weighs as much as a spacing; >= 0
    std::int64_t min_size = 1;  ///< no region of fewer pixels, but for islands of a mask; >= 1
};

struct Segmentation {
    Cells cells;
    Hierarchy hierarchy;  ///< whole: beyond where the labels stop
    std::size_t merges = 0;
    LabelImage labels;  ///< after so many merges
};

/// The image of a level as seen through its map: L*u*v*, zero outside the mask. Throws Error(kUnsupported)
/// for a mesh without colour.
FeatureImage reconstruct_luv(const Level& level);

/// Patches, cut where they are not connected, merge until `params` say stop. image: L*u*v*, of the map's
/// size. Same result for any number of threads.
///
/// Throws Error(kBadArgument) for a parameter out of range, an image of another size, more regions than
/// there are connected parts of patches (of that least size), or fewer than the mask has islands;
/// Error(kUnsupported) for an image without colour or a mask without a pixel.
Segmentation segment(const Level& level, const FeatureImage& picture, const SegmentParams& params,
                     const Progress& progress = {});

}  // namespace imgmesh
