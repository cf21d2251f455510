#include "libcore/segment/contour_map.h"

#include <algorithm>
#include <limits>
#include <numeric>

namespace imgmesh {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

// Answers at which merge two cells become one. It is a forest in which each merge hangs the smaller tree
// below the larger one, so paths are short. Every link knows its merge.
class Joins {
  public:
    explicit Joins(const Hierarchy& hierarchy)
        : merges_(hierarchy.merges),
          parent_(hierarchy.cells),
          merge_(hierarchy.cells, hierarchy.merges.size()) {
        std::iota(parent_.begin(), parent_.end(), Id{0});
        std::vector<std::size_t> size(hierarchy.cells, 1);
        for (std::size_t k = 0; k < merges_.size(); ++k) {
            Id a = root(merges_[k].a), b = root(merges_[k].b);
            if (size[a] < size[b]) std::swap(a, b);
            size[a] += size[b];
            parent_[b] = a;
            merge_[b] = k;
        }
    }

    float height(Id a, Id b) const {
        // Links further up are later. The last one on the path from a to b is the merge of a and b.
        std::size_t last = merges_.size();
        while (a != b) {
            if (merge_[a] > merge_[b]) std::swap(a, b);
            last = merge_[a];
            if (last == merges_.size()) return kNever;  // two roots
            a = parent_[a];
        }
        return merges_[last].height;
    }

  private:
    Id root(Id cell) const {
        while (parent_[cell] != cell) cell = parent_[cell];
        return cell;
    }

    const std::vector<Merge>& merges_;
    std::vector<Id> parent_;
    std::vector<std::size_t> merge_;  // of the link to the parent; for roots the number of merges
};

}  // namespace

ContourMap contour_map(const Cells& cells, const Hierarchy& hierarchy) {
    const Joins joins(hierarchy);
    ContourMap map({2 * cells.width + 1, 2 * cells.height + 1});
    const auto between = [&](Id a, Id b) {
        if (a == b) return 0.0f;
        return a == kNone || b == kNone ? kNever : joins.height(a, b);
    };
    for (int y = 0; y < cells.height; ++y)
        for (int x = 0; x < cells.width; ++x) {
            const Id cell = cells.at(x, y);
            if (x + 1 < cells.width) map.at(2 * x + 2, 2 * y + 1) = between(cell, cells.at(x + 1, y));
            if (y + 1 < cells.height) map.at(2 * x + 1, 2 * y + 2) = between(cell, cells.at(x, y + 1));
        }
    for (int y = 2; y + 1 < map.height; y += 2)
        for (int x = 2; x + 1 < map.width; x += 2)
            map.at(x, y) = std::max({map.at(x - 1, y), map.at(x + 1, y), map.at(x, y - 1), map.at(x, y + 1)});
    return map;
}

}  // namespace imgmesh
