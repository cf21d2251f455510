// An object chosen by a few pixels: seeds inside it and seeds outside, and the hierarchy does the rest.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "libcore/image/mask.h"
#include "libcore/segment/segment.h"

namespace imgmesh {

/// Pixels that belong to the object, or to what is around it.
struct Seed {
    struct Point {
        std::int64_t x = 0;
        std::int64_t y = 0;
    };
    std::vector<Point> points;  ///< one pixel, or the corners of a line through pixels
    bool keep = true;           ///< inside the object
    std::string where;          ///< what messages call it, such as "keep 250,260"
};

/// Returns the object's pixels.
///
/// With seeds of both kinds each cell goes to the kind that it is joined with by the earlier merge, that is,
/// across the lowest borders of the contour map. If that merge joins it with both kinds at once, its region
/// goes with all of its cells to the kind along which it has the longer border; between equal ones it is
/// dropped. Islands of a mask without a seed are dropped.
///
/// With seeds of one kind the regions of `result.labels` count: only those that hold a seed are kept, or all
/// but those.
///
/// Takes O(pixels log pixels) time. Throws Error: kBadArgument without a seed, and for a seed that is not
/// within the image or of which no pixel is inside the mask; kUnsupported if one cell holds seeds of both
/// kinds, or if no pixel is kept.
Mask choose_by_seeds(const Segmentation& result, std::span<const Seed> seeds);

/// Returns the mask as a grey image of 8 bits: white inside, black outside.
Image mask_image(const Mask& mask);

}  // namespace imgmesh
