// Segmentation from end to end: a level of a container and an image in, labelled regions out.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "libcore/base/progress.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/segment/labels.h"

namespace imgmesh {

enum class DistanceRule {
    kContour,  ///< contrast along the border, colour, texture, size and shape
               ///< (docs/decisions/0036-contours-with-texture.md)
    kPaper     ///< the difference of weighted mean colours (paper sec. 4.1)
};

/// How carefully contours are measured; of DistanceRule::kContour only.
enum class SegmentQuality {
    kFast,    ///< once, by squares of pixels
    kDefault  ///< again along smoothed outlines, with texture and direction
};

/// With SegmentParams::clearest, the threshold is up to this factor higher or lower.
inline constexpr double kClearestRange = 1.1;

/// Where merging stops. Give at most one of `segments` and `superpixels`; without them `threshold` counts.
struct SegmentParams {
    DistanceRule distance = DistanceRule::kContour;  ///< not for superpixels, which have their own
    SegmentQuality quality = SegmentQuality::kDefault;
    double threshold = 8.0;  ///< regions closer than this become one [L*u*v*]; > 0
    bool clearest = false;   ///< near `threshold` where the regions change least (clearest_merges())
    std::optional<std::int64_t> segments;     ///< this many regions; >= 1
    std::optional<std::int64_t> superpixels;  ///< this many regions of similar size that follow edges; >= 1
    double compactness = 4.0;   ///< of superpixels: this L*u*v* distance counts as much as one spacing; >= 0
    std::int64_t min_size = 1;  ///< no region has fewer pixels, except islands of a mask; >= 1
};

/// Regions, and all that leads to them.
struct Segmentation {
    Cells cells;
    Hierarchy hierarchy;  ///< all merges, also those after the labels' threshold
    std::size_t merges = 0;
    LabelImage labels;   ///< after the first `merges` merges
    std::string missed;  ///< why there are not as many regions as wanted; "" if there are
};

/// Draws the image of a level through its map: L*u*v*, zero outside the mask. For segment(), if the image
/// itself is not at hand. Throws Error(kUnsupported) for a mesh without colour.
FeatureImage reconstruct_luv(const Level& level);

/// Segments an image (paper sec. 4.1): cuts patches that are not connected into cells, and merges cells,
/// closest first, until `params` says stop. The image is L*u*v* (luv_image, reconstruct_luv), of the map's
/// size. The result is the same for any number of threads. Takes O(pixels + borders log borders) time for
/// photographs.
///
/// Superpixels are cells merged and then given smooth outlines that follow the image's pixels. In their
/// result they are the cells, `merges` is 0, and the hierarchy merges them further.
///
/// Where more regions are wanted than there are cells (of at least min_size pixels; of superpixels, than
/// there are pixels), or fewer than the mask has islands, the number is as near as possible, and `missed`
/// tells why.
///
/// Throws Error(kBadArgument) for a parameter out of range and an image of another size; Error(kUnsupported)
/// for an image without colour or a mask without a pixel inside.
Segmentation segment(const Level& level, const FeatureImage& image, const SegmentParams& params,
                     const Progress& progress = {});

}  // namespace imgmesh
