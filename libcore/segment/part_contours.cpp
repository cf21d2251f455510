#include "libcore/segment/part_contours.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/error.h"
#include "libcore/segment/connected_parts.h"
#include "libcore/segment/contours/contour_contrasts.h"
#include "libcore/segment/contours/majority.h"
#include "libcore/segment/first_regions.h"

namespace imgmesh {
namespace {

PixelRect within(const PixelRect& rect, const PixelRect& window) {
    return {rect.left - window.left, rect.top - window.top, rect.right - window.left,
            rect.bottom - window.top};
}

Grid<Id> cropped(const Grid<Id>& grid, const PixelRect& rect) {
    Grid<Id> part(GridSize{rect.width(), rect.height()});
    for (int y = 0; y < part.height; ++y)
        std::ranges::copy(grid.row(rect.top + y).subspan(as_index(rect.left), as_index(part.width)),
                          part.row(y).begin());
    return part;
}

// Smooths outlines part by part, and joins what is connected over their sides.
class SmoothParts {
  public:
    SmoothParts(const PictureParts& picture, const PartLabels& labels, std::size_t count, int radius)
        : picture_(picture),
          labels_(labels),
          count_(count),
          radius_(radius),
          above_(as_index(picture.grid.columns())),
          smooth_(picture.grid) {}

    void add(int column, int row) {
        const PixelRect rect = picture_.grid.rect(column, row);
        const PixelRect window = picture_.grid.window(column, row, radius_);
        const Grid<Id> label =
            cropped(majority_labels({labels_.window(window), count_}, radius_), within(rect, window));
        ConnectedParts parts = connected_parts(
            label, [&](std::size_t i) { return label[i] != kNone; },
            [&](std::size_t i, std::size_t j) { return label[i] == label[j]; });
        if (!parts.first.empty()) {
            const PicturePart part = picture_.read(column, row);
            const std::vector<RegionSums> sums =
                region_sums(parts.part, parts.first.size(), part.map, part.luv);
            add_parts(parts, sums, rect);
        }
        smooth_.set(column, row, parts.part);

        Side left, last;
        for (int y = 0; y < label.height; ++y) {
            left.push_back({label.at(0, y), parts.part.at(0, y)});
            last.push_back({label.at(label.width - 1, y), parts.part.at(label.width - 1, y)});
        }
        if (column > 0) join(left_, left);
        left_ = std::move(last);
        Side top, bottom;
        for (int x = 0; x < label.width; ++x) {
            top.push_back({label.at(x, 0), parts.part.at(x, 0)});
            bottom.push_back({label.at(x, label.height - 1), parts.part.at(x, label.height - 1)});
        }
        if (row > 0) join(above_[as_index(column)], top);
        above_[as_index(column)] = std::move(bottom);
    }

    // Returns the labels and the sums of all connected parts.
    std::pair<PartLabels, std::vector<RegionSums>> finish() {
        DisjointSets sets(sums_.size());
        for (const auto& [a, b] : joins_) sets.join(a, b);
        std::vector<Id> place(sums_.size(), kNone);  // of a set's least member
        std::vector<std::int64_t> first;
        std::vector<RegionSums> sums;
        for (Id i = 0; i < sums_.size(); ++i) {
            const Id set = sets.find(i);
            if (set == i) {
                place[i] = as_id(first.size());
                first.push_back(first_[i]);
                sums.push_back(sums_[i]);
            } else {
                place[i] = place[set];
                first[place[i]] = std::min(first[place[i]], first_[i]);
                sums[place[i]] += sums_[i];
            }
        }
        const std::vector<Id> rank = ranks(first);
        for (Id& number : place) number = rank[number];
        std::vector<RegionSums> ordered(sums.size());
        for (std::size_t k = 0; k < sums.size(); ++k) ordered[rank[k]] = sums[k];
        smooth_.renumber(place);
        return {std::move(smooth_), std::move(ordered)};
    }

  private:
    struct SidePixel {
        Id label, part;
    };
    using Side = std::vector<SidePixel>;

    // Appends the parts, and gives them their numbers among all.
    void add_parts(ConnectedParts& parts, const std::vector<RegionSums>& sums, const PixelRect& rect) {
        if (sums_.size() + sums.size() >= kNone)
            throw Error(ErrorKind::kUnsupported,
                        "the picture has more regions than there are 32-bit numbers");
        const Id base = as_id(sums_.size());
        const std::vector<std::int64_t> first =
            first_pixels(parts.part, sums.size(), rect, picture_.grid.size().width);
        first_.insert(first_.end(), first.begin(), first.end());
        sums_.insert(sums_.end(), sums.begin(), sums.end());
        for (Id& part : parts.part.values)
            if (part != kNone) part += base;
    }

    void join(const Side& a, const Side& b) {
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (a[i].label == kNone || a[i].label != b[i].label) continue;
            const std::pair both(a[i].part, b[i].part);
            if (joins_.empty() || joins_.back() != both) joins_.push_back(both);
        }
    }

    const PictureParts& picture_;
    const PartLabels& labels_;
    std::size_t count_;
    int radius_;
    Side left_;                // the last column of the part before
    std::vector<Side> above_;  // by column of parts: the last row of the part above
    PartLabels smooth_;
    std::vector<RegionSums> sums_;     // of each connected part of a part
    std::vector<std::int64_t> first_;  // and its first pixel
    std::vector<std::pair<Id, Id>> joins_;
};

}  // namespace

RegionGraph contour_graph(const PictureParts& picture, PartLabels& labels, std::size_t count, int radius,
                          const SmallImage& small, const Progress& progress) {
    const PartGrid& grid = picture.grid;
    const auto each_part = [&](double from, double share, std::string_view stage, const auto& act) {
        for (int row = 0; row < grid.rows(); ++row)
            for (int column = 0; column < grid.columns(); ++column) {
                if (progress)
                    progress(from + share * (row + column / double(grid.columns())) / grid.rows(), stage);
                act(column, row);
            }
    };
    RegionGraph graph;
    SmoothParts smooth(picture, labels, count, radius);
    each_part(0, 0.5, "outlines", [&](int column, int row) { smooth.add(column, row); });
    std::tie(labels, graph.regions) = smooth.finish();

    ContourPlaces places(grid.size(), small.factor);
    each_part(0.5, 0.2, "contours", [&](int column, int row) {
        const PixelRect window = grid.window(column, row, places.margin());
        places.add(labels.window(window), window.left, window.top, within(grid.rect(column, row), window));
    });
    places.measure(small);
    each_part(0.8, 0.2, "contours", [&](int column, int row) {
        const PixelRect window = grid.window(column, row, 1), own = within(grid.rect(column, row), window);
        const Grid<Id> regions = labels.window(window);
        std::vector<Crossing> crossings;
        add_crossings(crossings, regions, places.contrasts(regions, window.left, window.top, own), own);
        const std::vector<Border> borders = borders_of(std::move(crossings));
        graph.borders.insert(graph.borders.end(), borders.begin(), borders.end());
    });
    graph.borders = joined_borders(std::move(graph.borders));
    return graph;
}

}  // namespace imgmesh
