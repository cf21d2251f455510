// Merging of regions, closest first.
#pragma once

#include <cstdint>
#include <functional>

#include "libcore/segment/hierarchy.h"
#include "libcore/segment/region_graph.h"

namespace imgmesh {

/// The distance of two regions with a common border: finite, >= 0, and symmetric.
using RegionDistance = std::function<double(const RegionSums&, const RegionSums&, const Border&)>;

/// Merges the two closest neighbours until none are left, and computes the distances of the new region anew
/// (paper sec. 4.1, "repeatedly"). In a tie the smaller regions merge first, so that in a flat area none
/// grows by one neighbour at a time; then those with the lower numbers; the number of a region is that of its
/// first cell. If `min_size` > 1, regions with fewer pixels merge first, closest first, at height 0, so no
/// region is smaller at any threshold, except islands that are smaller as a whole. Other merges end when
/// `least` regions are left.
///
/// Takes O(borders log borders) time, and computes the distances of every region that grows anew: a region
/// with very many neighbours costs one look at each of them whenever it grows.
Hierarchy merge_regions(RegionGraph graph, const RegionDistance& distance, std::int64_t min_size = 1,
                        std::size_t least = 1);

/// Merges, and the regions that they leave.
struct MergedRegions {
    Hierarchy hierarchy;
    RegionGraph graph;  ///< regions numbered by their first cells
};

/// The same until `least` regions are left. Merging the graph of the result further gives the very merges
/// that would have followed.
MergedRegions merge_to(RegionGraph graph, const RegionDistance& distance, std::size_t least);

}  // namespace imgmesh
