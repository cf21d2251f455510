// Merging of regions, closest first, and what it leaves: a hierarchy.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// One merge: the regions that hold cells a and b become one.
struct Merge {
    Id a = kNone;      ///< a cell of the one region
    Id b = kNone;      ///< a cell of the other
    float height = 0;  ///< threshold above which the two are one: the largest distance merged so far
};

/// All merges of an image's cells, in order; heights never fall. Cells are connected where the image is,
/// so a mask of k islands leaves k regions in the end.
struct Hierarchy {
    std::size_t cells = 0;
    std::vector<Merge> merges;
    std::size_t forced = 0;  ///< the first so many are those that min_size asked for, at height 0
};

/// How far two regions with a common border are apart: finite, >= 0, the same whichever comes first.
using RegionDistance = std::function<double(const RegionSums&, const RegionSums&, const Border&)>;

/// Merges the two closest neighbours until none are left, the distances of the new region computed anew
/// (paper sec. 4.1, "repeatedly"). Ties: the border of the lower regions, a region being called by its first
/// cell. Where `min_size` > 1, merges of regions with fewer pixels come first, closest first, at height 0: so
/// that no region is smaller at any threshold, but for islands that are smaller as a whole.
///
/// O(borders log borders) times the mean number of neighbours of a region at its merges.
Hierarchy merge_regions(RegionGraph graph, const RegionDistance& distance, std::int64_t min_size = 1);

/// The number of merges whose height is below `threshold`.
std::size_t merges_below(const Hierarchy& hierarchy, double threshold);

/// The region of every cell after the first `merges` merges. Regions are numbered by their first cell.
std::vector<Id> regions_after(const Hierarchy& hierarchy, std::size_t merges);

}  // namespace imgmesh
