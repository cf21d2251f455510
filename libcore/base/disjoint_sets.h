// Sets of numbers that grow together, and nothing else.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "libcore/base/index.h"

namespace imgmesh {

/// 0 .. size-1, each at first in a set of its own. A set is known by its least member, whatever the order of
/// joins.
class DisjointSets {
  public:
    explicit DisjointSets(std::size_t size) : parent_(size) {
        std::iota(parent_.begin(), parent_.end(), Id{0});
    }

    /// The least member of the set that holds i. Nearly constant time.
    Id find(Id i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(Id i, Id j) {
        const Id a = find(i), b = find(j);
        parent_[std::max(a, b)] = std::min(a, b);
    }
    std::int64_t count() const {
        std::int64_t sets = 0;
        for (Id i = 0; i < parent_.size(); ++i) sets += parent_[i] == i;
        return sets;
    }

  private:
    std::vector<Id> parent_;
};

}  // namespace imgmesh
