#include "libcore/segment/merge_heights.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

#include "libcore/base/disjoint_sets.h"

namespace imgmesh {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();

// Regions as lists of cells, joined end to end.
struct Lists {
    std::vector<Id> next, last;  // last: of the list that begins with a cell
    std::vector<float> height;   // between a cell and the next

    explicit Lists(std::size_t cells) : next(cells, kNone), last(cells), height(cells, kNever) {
        std::iota(last.begin(), last.end(), Id{0});
    }
    void append(Id list, Id other, float at) {
        next[last[list]] = other;
        height[last[list]] = at;
        last[list] = last[other];
    }
};

}  // namespace

MergeHeights::MergeHeights(const Hierarchy& hierarchy, float least) : places_(hierarchy.cells) {
    Lists lists(hierarchy.cells);
    DisjointSets regions(hierarchy.cells);  // a list begins with the least cell of its region
    for (const Merge& merge : hierarchy.merges) {
        const Id a = regions.find(merge.a), b = regions.find(merge.b);
        lists.append(std::min(a, b), std::max(a, b), merge.height);
        regions.join(a, b);
    }
    for (Id root = 0; root < hierarchy.cells; ++root) {
        if (regions.find(root) != root) continue;
        for (Id cell = root; cell != kNone; cell = lists.next[cell]) {
            places_[cell] = as_id(height_.size());
            if (lists.height[cell] >= least) height_.push_back(lists.height[cell]);
        }
    }

    const std::size_t blocks = (height_.size() + kBlock - 1) / kBlock;
    to_end_ = from_begin_ = height_;
    largest_.emplace_back(blocks);
    for (std::size_t i = 0; i < height_.size(); ++i) {
        if (i % kBlock != 0) from_begin_[i] = std::max(from_begin_[i], from_begin_[i - 1]);
        largest_[0][i / kBlock] = from_begin_[i];
    }
    for (std::size_t i = height_.size(); i-- > 0;)
        if ((i + 1) % kBlock != 0 && i + 1 < height_.size())
            to_end_[i] = std::max(to_end_[i], to_end_[i + 1]);
    for (std::size_t span = 1; 2 * span <= blocks; span *= 2) {
        const std::vector<float>& half = largest_.back();
        std::vector<float> whole(blocks - 2 * span + 1);
        for (std::size_t i = 0; i < whole.size(); ++i) whole[i] = std::max(half[i], half[i + span]);
        largest_.push_back(std::move(whole));
    }
}

float MergeHeights::largest(std::size_t first, std::size_t last) const {
    if (first >= last) return 0;
    const auto k = static_cast<std::size_t>(std::bit_width(last - first) - 1);
    return std::max(largest_[k][first], largest_[k][last - (std::size_t{1} << k)]);
}

float MergeHeights::between(Id a, Id b) const {
    if (a == b) return 0;
    const std::size_t first = std::min(a, b), last = std::max(a, b) - 1;
    const std::size_t first_block = first / kBlock, last_block = last / kBlock;
    if (first_block == last_block) return *std::max_element(&height_[first], &height_[last] + 1);
    return std::max({to_end_[first], from_begin_[last], largest(first_block + 1, last_block)});
}

}  // namespace imgmesh
