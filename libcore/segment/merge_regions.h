// Merging of regions, closest first, and the resulting hierarchy.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// One merge: the regions that hold cells a and b become one.
struct Merge {
    Id a = kNone;      ///< a cell of one region
    Id b = kNone;      ///< a cell of the other region
    float height = 0;  ///< the threshold above which the two are one: the largest distance merged so far
};

/// All merges of an image's cells, in order. Heights never fall. Cells on different islands of a mask never
/// merge, so k islands leave k regions in the end.
struct Hierarchy {
    std::size_t cells = 0;
    std::vector<Merge> merges;
    std::size_t forced = 0;  ///< this many merges come first, at height 0, because of min_size
};

/// The distance of two regions with a common border: finite, >= 0, and symmetric.
using RegionDistance = std::function<double(const RegionSums&, const RegionSums&, const Border&)>;

/// Merges the two closest neighbours until none are left, and computes the distances of the new region anew
/// (paper sec. 4.1, "repeatedly"). In a tie the border of the lower regions comes first; the number of a
/// region is that of its first cell. If `min_size` > 1, regions with fewer pixels merge first, closest first,
/// at height 0, so no region is smaller at any threshold, except islands that are smaller as a whole.
///
/// Takes O(borders log borders) time, times the mean number of neighbours of a region when it merges.
Hierarchy merge_regions(RegionGraph graph, const RegionDistance& distance, std::int64_t min_size = 1);

/// Returns the number of merges whose height is below `threshold`.
std::size_t merges_below(const Hierarchy& hierarchy, double threshold);

/// Returns each cell's region after `merges` merges. Regions are numbered by their first cell.
std::vector<Id> regions_after(const Hierarchy& hierarchy, std::size_t merges);

}  // namespace imgmesh
