#include "libcore/segment/part_labels.h"

#include <algorithm>

namespace imgmesh {

PixelRect PartGrid::window(int column, int row, int margin) const {
    const PixelRect own = rect(column, row);
    return {std::max(0, own.left - margin), std::max(0, own.top - margin),
            std::min(x.back(), own.right + margin), std::min(y.back(), own.bottom + margin)};
}

PixelRect PartGrid::parts_at(const PixelRect& rect) const {
    const auto part = [](const std::vector<int>& lines, int at) {
        return as_int(as_index(std::ranges::upper_bound(lines, at) - lines.begin())) - 1;
    };
    return {part(x, rect.left), part(y, rect.top), part(x, rect.right - 1) + 1, part(y, rect.bottom - 1) + 1};
}

PartLabels::PartLabels(PartGrid grid)
    : grid_(std::move(grid)), parts_(as_index(grid_.columns()) * as_index(grid_.rows())) {}

void PartLabels::set(int column, int row, const Grid<Id>& labels) {
    Part& part = parts_[index(column, row)] = {};
    for (int y = 0; y < labels.height; ++y) {
        part.begin.push_back(part.runs.size());
        for (int x = 0; x < labels.width; ++x) {
            const Id label = labels.at(x, y);
            if (x == 0 || part.runs.back().label != label) part.runs.push_back({label, x});
            part.runs.back().end = x + 1;
        }
    }
    part.begin.push_back(part.runs.size());
    part.runs.shrink_to_fit();
}

void PartLabels::renumber(const std::vector<Id>& numbers) {
    for (Part& part : parts_) {
        std::size_t kept = 0;
        for (std::size_t row = 0; row + 1 < part.begin.size(); ++row) {
            const std::size_t first = kept;
            for (std::size_t i = part.begin[row]; i < part.begin[row + 1]; ++i) {
                Run run = part.runs[i];
                if (run.label != kNone) run.label = numbers[run.label];
                if (kept > first && part.runs[kept - 1].label == run.label)
                    part.runs[kept - 1].end = run.end;
                else
                    part.runs[kept++] = run;
            }
            part.begin[row] = first;
        }
        if (part.begin.empty()) continue;
        part.begin.back() = kept;
        part.runs.resize(kept);
        part.runs.shrink_to_fit();
    }
}

Grid<Id> PartLabels::window(const PixelRect& rect) const {
    Grid<Id> labels(GridSize{rect.width(), rect.height()}, kNone);
    const PixelRect at = grid_.parts_at(rect);
    for (int row = at.top; row < at.bottom; ++row)
        for (int column = at.left; column < at.right; ++column) {
            const Part& part = parts_[index(column, row)];
            if (part.begin.empty()) continue;
            const PixelRect own = grid_.rect(column, row);
            const int right = std::min(rect.right, own.right);
            for (int y = std::max(rect.top, own.top); y < std::min(rect.bottom, own.bottom); ++y) {
                const std::size_t line = as_index(y - own.top);
                int x = std::max(rect.left, own.left);
                const auto* const first = part.runs.data() + part.begin[line];
                const auto* const last = part.runs.data() + part.begin[line + 1];
                const auto* run = std::upper_bound(
                    first, last, x - own.left, [](int column_at, const Run& r) { return column_at < r.end; });
                for (; x < right; ++run) {
                    const int end = std::min(right, own.left + run->end);
                    std::fill_n(&labels.at(x - rect.left, y - rect.top), end - x, run->label);
                    x = end;
                }
            }
        }
    return labels;
}

std::vector<std::int64_t> PartLabels::count_pixels(std::size_t count) const {
    std::vector<std::int64_t> pixels(count, 0);
    for (const Part& part : parts_)
        for (std::size_t i = 0, row = 0; i < part.runs.size(); ++i) {
            while (part.begin[row + 1] <= i) ++row;
            const int from = i == part.begin[row] ? 0 : part.runs[i - 1].end;
            if (part.runs[i].label != kNone) pixels[part.runs[i].label] += part.runs[i].end - from;
        }
    return pixels;
}

std::vector<std::int64_t> PartLabels::count_parts(std::size_t count) const {
    std::vector<std::int64_t> parts(count, 0);
    std::vector<std::size_t> last(count, parts_.size());  // part that was counted
    for (std::size_t k = 0; k < parts_.size(); ++k)
        for (const Run& run : parts_[k].runs) {
            if (run.label == kNone || last[run.label] == k) continue;
            last[run.label] = k;
            ++parts[run.label];
        }
    return parts;
}

}  // namespace imgmesh
