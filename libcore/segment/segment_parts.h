// Segmentation of a picture in parts, of which one is held at a time.
#pragma once

#include <functional>
#include <string>

#include "libcore/segment/part_labels.h"
#include "libcore/segment/segment.h"

namespace imgmesh {

/// A part of a picture as it is segmented. Both are empty where the picture has no pixels.
struct PicturePart {
    PixelMap map;      ///< faces of its own; parts never share one
    FeatureImage luv;  ///< L*u*v*
};

/// A picture that is read part by part.
struct PictureParts {
    PartGrid grid;
    /// Returns a part: always the same, of the size of grid.rect(column, row).
    std::function<PicturePart(int column, int row)> read;
};

/// Regions of a picture in parts.
struct PartSegmentation {
    PartLabels labels;      ///< numbered from 0 by their first pixel in the picture, row by row
    std::size_t count = 0;  ///< of regions
    std::size_t cells = 0;  ///< of all parts
    Hierarchy hierarchy;    ///< the merges of the last stage
    std::size_t merges = 0;
    std::string missed;  ///< as in Segmentation
};

/// Returns about how much memory segment_parts() takes beside one part and what reads it [bytes].
double part_memory(const PartGrid& grid, const SegmentParams& params);

/// Does what segment() does, for a picture of any size, by the same rules and with nearly the same regions:
/// exactly the same for one part, unless there are more regions than the bounds below leave. Parameters mean
/// the same; `superpixels` are refused.
///
/// 1. Each part is merged as far as the memory for its regions asks (fine_regions()); parts of pictures of a
///    few megapixels are not. Contrasts reach over the parts' sides.
/// 2. The regions of all parts are one graph, in which parts' sides are borders like others, and merging goes
///    on as if there were no parts.
/// 3. The second stage (contour_hierarchy.h), of the whole picture at the size at which contours are
///    measured, which is small for any picture.
///
/// Reads each part three times, twice for kFast, once for kPaper. Holds one part and part_memory(). The
/// result is the same for any number of threads.
///
/// Throws Error(kBadArgument) as segment() does, Error(kUnsupported) for superpixels and for a picture
/// without a pixel inside.
PartSegmentation segment_parts(const PictureParts& picture, const SegmentParams& params,
                               const Progress& progress = {});

}  // namespace imgmesh
