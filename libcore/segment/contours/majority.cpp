#include "libcore/segment/contours/majority.h"

#include <algorithm>
#include <vector>

#include "libcore/base/parallel.h"
#include "libcore/segment/connected_parts.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 16;  // rows a block

std::vector<std::pair<int, int>> disc(int radius) {
    std::vector<std::pair<int, int>> offsets;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if (dx * dx + dy * dy <= radius * radius) offsets.emplace_back(dx, dy);
    return offsets;
}

// Finds the majority around pixels; `votes` has a zero for each label between calls.
class Majority {
  public:
    Majority(const LabelImage& labels, int radius)
        : labels_(labels), offsets_(disc(radius)), votes_(labels.count, 0) {}

    Id around(int x, int y) {
        seen_.clear();
        for (const auto& [dx, dy] : offsets_) {
            if (!labels_.contains(x + dx, y + dy)) continue;
            const Id label = labels_.at(x + dx, y + dy);
            if (label == kNone) continue;
            if (votes_[label]++ == 0) seen_.push_back(label);
        }
        const Id own = labels_.at(x, y);
        Id best = own;
        for (const Id label : seen_)
            if (votes_[label] > votes_[best] ||
                (votes_[label] == votes_[best] && best != own && label < best))
                best = label;
        for (const Id label : seen_) votes_[label] = 0;
        return best;
    }

  private:
    const LabelImage& labels_;
    std::vector<std::pair<int, int>> offsets_;
    std::vector<int> votes_;
    std::vector<Id> seen_;
};

// Whether a row has another label within `radius` of each pixel, in the square around it: where there is
// none, there is nothing to vote about.
std::vector<std::uint8_t> near_outlines(const LabelImage& labels, int radius) {
    const auto spread = [&](std::vector<std::uint8_t>& marks, std::size_t step, std::size_t count,
                            std::size_t first) {
        std::vector<std::uint8_t> copy(count);
        for (std::size_t i = 0; i < count; ++i) copy[i] = marks[first + i * step];
        int inside = 0;
        for (int i = -radius; i < as_int(count); ++i) {
            if (i + radius < as_int(count)) inside += copy[as_index(i + radius)];
            if (i - radius - 1 >= 0) inside -= copy[as_index(i - radius - 1)];
            if (i >= 0) marks[first + as_index(i) * step] = inside > 0;
        }
    };
    std::vector<std::uint8_t> marks(labels.size(), 0);
    for_neighbor_pixels(labels, [&](std::size_t i, std::size_t j) {
        if (labels[i] != labels[j]) marks[i] = marks[j] = 1;
    });
    for (int y = 0; y < labels.height; ++y) spread(marks, 1, as_index(labels.width), labels.row_begin(y));
    for (int x = 0; x < labels.width; ++x)
        spread(marks, as_index(labels.width), as_index(labels.height), as_index(x));
    return marks;
}

}  // namespace

Grid<Id> majority_labels(const LabelImage& labels, int radius) {
    const std::vector<std::uint8_t> near = near_outlines(labels, radius);
    Grid<Id> smooth = labels;
    parallel_blocks(0, labels.height, kGrain, [&](int begin, int end) {
        Majority majority(labels, radius);
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < labels.width; ++x)
                if (near[labels.index(x, y)] && labels.at(x, y) != kNone)
                    smooth.at(x, y) = majority.around(x, y);
    });
    return smooth;
}

LabelImage smooth_outlines(const LabelImage& labels, int radius) {
    const Grid<Id> smooth = majority_labels(labels, radius);
    ConnectedParts parts = connected_parts(
        smooth, [&](std::size_t i) { return smooth[i] != kNone; },
        [&](std::size_t i, std::size_t j) { return smooth[i] == smooth[j]; });
    return {std::move(parts.part), parts.first.size()};
}

}  // namespace imgmesh
