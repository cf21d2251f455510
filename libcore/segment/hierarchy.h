// The order in which the cells of an image merge into regions: all segmentations of one image at once.
#pragma once

#include <cstddef>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// One merge: the region that holds cell a and the region that holds cell b become one.
struct Merge {
    Id a = kNone;
    Id b = kNone;
    float height = 0;  ///< the two are one for every threshold above: the largest distance merged so far
};

/// All merges of an image's cells (cells.h), closest regions first; heights never fall. Without a mask all
/// cells end up in one region, with a mask of k islands in k.
struct Hierarchy {
    std::size_t cells = 0;
    std::vector<Merge> merges;
    /// The first so many merges have height 0: they join regions smaller than SegmentParams::min_size.
    std::size_t forced = 0;
};

/// The number of merges whose height is below `threshold`. O(log merges).
std::size_t merges_below(const Hierarchy& hierarchy, double threshold);

/// The region of every cell after the first `merges` merges (at most hierarchy.merges.size()). Regions are
/// numbered from 0 in the order of their lowest cells. O(cells).
std::vector<Id> regions_after(const Hierarchy& hierarchy, std::size_t merges);

}  // namespace imgmesh
