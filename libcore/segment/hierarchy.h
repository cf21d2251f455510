// The order in which the cells of an image merge into regions: all segmentations of one image at once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// One merge: the regions that hold cells a and b become one.
struct Merge {
    Id a = kNone;
    Id b = kNone;
    float height = 0;  ///< the threshold above which the two are one: the largest distance merged so far
};

/// All merges of an image's cells (cells.h), closest regions first. Heights never fall. Cells on different
/// islands of a mask never merge, so k islands leave k regions in the end.
struct Hierarchy {
    std::size_t cells = 0;
    std::vector<Merge> merges;
    std::size_t forced = 0;  ///< this many merges come first, at height 0, because of a least size
};

/// Returns the number of merges whose height is below `threshold`. Takes O(log merges) time.
std::size_t merges_below(const Hierarchy& hierarchy, double threshold);

/// Returns the number of merges that leaves `count` >= 1 regions, or as near as possible: there are never
/// more than after the forced merges, nor fewer than islands. `missed` then tells why; `source` is what more
/// regions would have to come from, such as "9 pixels".
std::size_t merges_to_count(const Hierarchy& hierarchy, std::int64_t count, std::string_view source,
                            std::string& missed);

/// Returns the number of merges to do if the threshold may be anything from `low` to `high`, 0 < low <= high:
/// where it could move farthest, by its factor, without a change. Noise then changes the regions least. The
/// first of equal ones counts. Takes O(log merges + merges in between) time.
std::size_t clearest_merges(const Hierarchy& hierarchy, double low, double high);

/// Returns each cell's region after the first `merges` merges, at most hierarchy.merges.size(). Regions are
/// numbered from 0 by their first cell. Takes O(cells + merges) time.
std::vector<Id> regions_after(const Hierarchy& hierarchy, std::size_t merges);

}  // namespace imgmesh
