// The height at which any two cells of a hierarchy become one region.
#pragma once

#include <vector>

#include "libcore/segment/hierarchy.h"

namespace imgmesh {

/// All cells in one row, so that every region of the hierarchy is a run of neighbours. Between neighbours is
/// the height at which they merge, and two cells merge at the largest height between them.
class MergeHeights {
  public:
    /// Merges below `least` count as done: their cells share a place. Takes O(cells log cells) time.
    MergeHeights(const Hierarchy& hierarchy, float least);

    /// Returns the place of every cell in the row.
    const std::vector<Id>& places() const { return places_; }

    /// Returns the height at which the cells at two places become one: 0 for one place, infinity for cells
    /// that never merge. Takes constant time.
    float between(Id a, Id b) const;

  private:
    static constexpr std::size_t kBlock = 16;

    float largest(std::size_t first, std::size_t last) const;  // of the blocks first <= i < last

    std::vector<Id> places_;
    std::vector<float> height_;                // between places i and i + 1
    std::vector<float> to_end_, from_begin_;   // the largest height from i to the end of its block, and back
    std::vector<std::vector<float>> largest_;  // [k][i]: of 2^k blocks from block i
};

}  // namespace imgmesh
