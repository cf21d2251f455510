#include "libcore/segment/first_regions.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "libcore/base/error.h"
#include "libcore/segment/contour_hierarchy.h"
#include "libcore/segment/labels.h"
#include "libcore/segment/merge_regions.h"
#include "libcore/segment/pair_contrasts.h"
#include "libcore/segment/part_windows.h"
#include "libcore/segment/region_distance.h"

namespace imgmesh {
namespace {

// Of the whole picture. Up to about 4 megapixels no part is merged then, and what is left to do is what the
// picture in one piece would have had: docs/decisions/0055-regions-of-tile-sets.md has figures.
constexpr double kFineRegions = 150'000, kFineForEach = 4;
// Of a small part of a huge picture.
constexpr double kPixelsOfFine = 4096, kMostFine = 64;

// Regions as they are found, numbered part by part.
class FirstPass {
  public:
    FirstPass(const PictureParts& picture, const SegmentParams& params, SmallImageSums* small)
        : picture_(picture),
          params_(params),
          small_(small),
          pixels_(double(picture.grid.size().pixel_count())),
          windows_(picture, is_contour() ? kSquareReach + 1 : 0),
          above_(as_index(picture.grid.columns())),
          found_{PartLabels(picture.grid), {}, 0} {}

    void add(int column, int row) {
        std::vector<Id>& above = above_[as_index(column)];
        if (column == 0) left_.clear();
        const PicturePart part = picture_.read(column, row);
        if (part.map.empty()) {
            left_.clear();
            above.clear();
            return;
        }
        const PixelRect rect = picture_.grid.rect(column, row);
        const Cells cells = cut_cells(part.map);
        found_.cells += cells.count();
        if (small_) small_->add(part.luv, cells, rect.left, rect.top);
        const Id outside = as_id(cells.count());
        const PartWindow window = windows_.window(column, row, part, cells, outside);
        const PairContrasts contrasts =
            is_contour() ? pair_contrasts(window.luv, window.cells) : PairContrasts{};

        RegionGraph graph{region_sums(cells, cells.count(), part.map, part.luv), {}};
        std::vector<Crossing> crossings;
        add_crossings(crossings, window.cells, contrasts, window.own);
        std::erase_if(crossings, [&](const Crossing& c) { return c.b == outside; });
        graph.borders = borders_of(std::move(crossings));
        const MergedRegions merged =
            merge_to(std::move(graph), is_contour() ? contour_distance(pixels_) : paper_distance(),
                     fine_regions(double(part.map.size()), pixels_, params_));
        LabelImage labels = labels_after(cells, merged.hierarchy, merged.hierarchy.merges.size());
        add_graph(merged.graph, labels, rect);
        add_sides(labels, window, contrasts, above);
        found_.labels.set(column, row, labels);

        left_.clear();
        for (int y = 0; y < labels.height; ++y) left_.push_back(labels.at(labels.width - 1, y));
        const std::span<const Id> last = labels.row(labels.height - 1);
        above.assign(last.begin(), last.end());
    }

    FirstRegions finish() {
        const std::vector<Id> numbers = ranks(first_);
        found_.labels.renumber(numbers);
        std::vector<RegionSums> sums(numbers.size());
        for (std::size_t i = 0; i < numbers.size(); ++i) sums[numbers[i]] = found_.graph.regions[i];
        found_.graph.regions = std::move(sums);
        for (Border& border : found_.graph.borders) {
            const Id a = numbers[border.a], b = numbers[border.b];
            border.a = std::min(a, b);
            border.b = std::max(a, b);
        }
        found_.graph.borders = joined_borders(std::move(found_.graph.borders));
        return std::move(found_);
    }

  private:
    bool is_contour() const { return params_.distance == DistanceRule::kContour; }

    // Appends the regions of a part, and gives its labels their numbers among all.
    void add_graph(const RegionGraph& graph, LabelImage& labels, const PixelRect& rect) {
        const std::size_t base = found_.graph.regions.size();
        if (base + graph.regions.size() >= kNone)
            throw Error(ErrorKind::kUnsupported,
                        "the picture has more regions than there are 32-bit numbers");
        const Id first = as_id(base);
        const std::vector<std::int64_t> places =
            first_pixels(labels, labels.count, rect, picture_.grid.size().width);
        first_.insert(first_.end(), places.begin(), places.end());
        for (Id& label : labels.values)
            if (label != kNone) label += first;
        found_.graph.regions.insert(found_.graph.regions.end(), graph.regions.begin(), graph.regions.end());
        for (const Border& border : graph.borders)
            found_.graph.borders.push_back(
                {border.a + first, border.b + first, border.length, border.contrast});
    }

    // Appends the borders with the parts to the left and above, whose regions are known by now.
    void add_sides(const LabelImage& labels, const PartWindow& window, const PairContrasts& contrasts,
                   const std::vector<Id>& above) {
        std::vector<Crossing> sides;
        const auto cross = [&](Id a, Id b, const std::vector<float>& contrast, int x, int y) {
            if (a == kNone || b == kNone) return;
            const float there = contrast.empty() ? 0 : contrast[window.cells.index(x, y)];
            sides.push_back({std::min(a, b), std::max(a, b), there});
        };
        const PixelRect& own = window.own;
        for (int y = 0; y < as_int(left_.size()); ++y)
            cross(left_[as_index(y)], labels.at(0, y), contrasts.right, own.left - 1, own.top + y);
        for (int x = 0; x < as_int(above.size()); ++x)
            cross(above[as_index(x)], labels.at(x, 0), contrasts.down, own.left + x, own.top - 1);
        const std::vector<Border> borders = borders_of(std::move(sides));
        found_.graph.borders.insert(found_.graph.borders.end(), borders.begin(), borders.end());
    }

    const PictureParts& picture_;
    const SegmentParams& params_;
    SmallImageSums* small_;
    double pixels_;
    PartWindows windows_;
    std::vector<Id> left_;                // regions of the last column of the part before
    std::vector<std::vector<Id>> above_;  // by column of parts: of the last row of the part above
    FirstRegions found_;
    std::vector<std::int64_t> first_;  // of each region: its first pixel
};

}  // namespace

std::size_t fine_regions(double part, double picture, const SegmentParams& params) {
    const double all = std::max(kFineRegions, kFineForEach * double(params.segments.value_or(0)));
    const double share = all * part / picture, least = std::min(kMostFine, part / kPixelsOfFine);
    return std::max<std::size_t>(1, static_cast<std::size_t>(std::min(part, std::max(share, least))));
}

FirstRegions first_regions(const PictureParts& picture, const SegmentParams& params, SmallImageSums* small,
                           const Progress& progress) {
    FirstPass pass(picture, params, small);
    const double parts = double(picture.grid.rows()) * picture.grid.columns();
    for (int row = 0; row < picture.grid.rows(); ++row)
        for (int column = 0; column < picture.grid.columns(); ++column) {
            if (progress) progress((double(row) * picture.grid.columns() + column) / parts, "parts");
            pass.add(column, row);
        }
    return pass.finish();
}

std::vector<Id> ranks(const std::vector<std::int64_t>& numbers) {
    std::vector<std::size_t> order(numbers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return numbers[i]; });
    std::vector<Id> rank(numbers.size());
    for (std::size_t k = 0; k < order.size(); ++k) rank[order[k]] = as_id(k);
    return rank;
}

std::vector<std::int64_t> first_pixels(const Grid<Id>& labels, std::size_t count, const PixelRect& rect,
                                       int picture_width) {
    std::vector<std::int64_t> first(count, -1);
    for (int y = 0; y < labels.height; ++y)
        for (int x = 0; x < labels.width; ++x)
            if (const Id label = labels.at(x, y); label != kNone && first[label] < 0)
                first[label] = std::int64_t{rect.top + y} * picture_width + rect.left + x;
    return first;
}

}  // namespace imgmesh
