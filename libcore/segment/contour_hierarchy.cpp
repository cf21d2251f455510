#include "libcore/segment/contour_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "libcore/segment/contours/contour_contrasts.h"
#include "libcore/segment/contours/majority.h"
#include "libcore/segment/contours/small_image.h"
#include "libcore/segment/merge_regions.h"
#include "libcore/segment/pair_contrasts.h"
#include "libcore/segment/region_distance.h"

namespace imgmesh {
namespace {

constexpr double kSmoothingRadius = 4;  // [pixels]

// The distance at 8 to 64 regions to which images are brought halfway: about the mean of photographs.
constexpr double kUsualDistance = 0.15;

// The greatest distance with a height of its own: keeps the logarithm finite.
constexpr double kMostDistance = 1 - 1e-9;

double count_pixels(const Grid<Id>& labels) {
    return double(std::count_if(labels.begin(), labels.end(), [](Id label) { return label != kNone; }));
}

// The geometric mean of an image's distances at 8, 16, 32 and 64 regions, as far as they are there and
// positive, against what is usual.
double relative_contrast(const Hierarchy& distances) {
    double sum = 0;
    int count = 0;
    const std::size_t merges = distances.merges.size();
    for (const std::size_t regions : {8u, 16u, 32u, 64u}) {
        if (regions > merges) continue;
        const auto distance = double(distances.merges[merges - regions].height);
        if (!(distance > 0)) continue;
        sum += std::log(distance / kUsualDistance);
        ++count;
    }
    return count == 0 ? 1 : std::exp(sum / count);
}

// The regions as cells; no single face holds them.
Cells cells_of(const LabelImage& labels) {
    Cells cells(labels);
    cells.values = labels.values;
    cells.face.assign(labels.count, kNone);
    return cells;
}

// Merges of the cells inside each region, as if there were no borders between regions.
Hierarchy merges_inside(const Cells& cells, const LabelImage& regions, RegionGraph graph,
                        const RegionDistance& distance) {
    std::vector<Id> region_of(cells.count());
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] != kNone) region_of[cells[i]] = regions[i];
    std::erase_if(graph.borders, [&](const Border& b) { return region_of[b.a] != region_of[b.b]; });
    return merge_regions(std::move(graph), distance);
}

// One hierarchy of cells: those inside regions merge first, below the height of every merge of regions; then
// the regions. With a least size, merges inside are forced, as are those of small regions. Cells and regions
// are both numbered by their first pixel, so a region's first cell stands for it.
Hierarchy joined(const Cells& cells, const LabelImage& regions, Hierarchy inside, const Hierarchy& outside,
                 bool forced) {
    std::vector<Id> first_cell(regions.count, kNone);
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (cells[i] != kNone) first_cell[regions[i]] = std::min(first_cell[regions[i]], cells[i]);
    const float most = inside.merges.empty() ? 0 : inside.merges.back().height;
    const float limit = forced ? 0 : outside.merges.empty() ? most : outside.merges.front().height;
    if (most > limit)
        for (Merge& merge : inside.merges) merge.height = limit * (merge.height / most);
    Hierarchy all{cells.count(), std::move(inside.merges), 0};
    if (forced) all.forced = all.merges.size() + outside.forced;
    for (const Merge& merge : outside.merges)
        all.merges.push_back({first_cell[merge.a], first_cell[merge.b], merge.height});
    return all;
}

}  // namespace

int smoothing_radius(double pixels) {
    return static_cast<int>(kSmoothingRadius * std::min(1.0, std::sqrt(pixels / kMeasuredPixels)));
}

void scale_heights(Hierarchy& hierarchy) {
    const double scale = std::clamp(1 / std::sqrt(relative_contrast(hierarchy)), 0.5, 2.0);
    for (Merge& merge : hierarchy.merges)
        merge.height = static_cast<float>(
            color_equivalent(-std::log(1 - std::min(kMostDistance, scale * double(merge.height)))));
}

double contour_memory(const GridSize& size) {
    constexpr double kBytes = 150;  // of filters' answers, sums and codes for each pixel that is measured
    const double factor = measuring_factor(size);
    return kBytes * double(size.pixel_count()) / (factor * factor);
}

CellHierarchy contour_hierarchy(const PixelMap& map, const FeatureImage& image, SegmentQuality quality,
                                std::int64_t min_size, const Progress& progress) {
    const auto tell = [&](double fraction, std::string_view stage) {
        if (progress) progress(fraction, stage);
    };
    const bool fast = quality == SegmentQuality::kFast;
    Cells patches = cut_cells(map);
    const double pixels = count_pixels(patches);
    const RegionDistance distance = contour_distance(pixels);
    tell(0.05, "contrasts");
    const PairContrasts squares = pair_contrasts(image, patches);
    tell(0.2, "merge");
    Hierarchy first =
        merge_regions(region_graph(patches, map, image, squares), distance, fast ? min_size : 1);
    if (fast) {
        scale_heights(first);
        return {std::move(patches), std::move(first)};
    }

    tell(0.3, "outlines");
    const std::size_t merges =
        std::min(first.merges.size(), first.cells - std::min(first.cells, kFirstRegions));
    const LabelImage regions =
        smooth_outlines(labels_after(patches, first, merges), smoothing_radius(pixels));
    tell(0.4, "contours");
    const Cells coarse = cells_of(regions);
    Hierarchy second = merge_regions(region_graph(coarse, map, image, contour_contrasts(image, regions)),
                                     distance, min_size);
    scale_heights(second);
    tell(0.9, "merge");
    Cells cells = cut_cells(map, regions);
    // Pairs that only the new outlines cut have no contrast here, but they lie between regions.
    Hierarchy inside = merges_inside(cells, regions, region_graph(cells, map, image, squares), distance);
    scale_heights(inside);
    Hierarchy all = joined(cells, regions, std::move(inside), second, min_size > 1);
    return {std::move(cells), std::move(all)};
}

}  // namespace imgmesh
