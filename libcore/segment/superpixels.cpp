#include "libcore/segment/superpixels.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/segment/blur_inside.h"
#include "libcore/segment/clean_edges.h"
#include "libcore/segment/connected_parts.h"
#include "libcore/segment/refine_outlines.h"
#include "libcore/segment/region_distance.h"

namespace imgmesh {
namespace {

// Regions get their outlines first when this many of them are left for each superpixel, and again in the
// end: merging then starts from parts with good outlines (docs/decisions/0010-superpixels.md). Where
// there are fewer cells, they are cut.
constexpr std::size_t kPartsEach = 4;

// Cuts cells along a grid of squares.
Cells cut_along_squares(const Cells& cells, int side) {
    const auto square = [&](std::size_t i) { return std::pair(cells.x_of(i) / side, cells.y_of(i) / side); };
    ConnectedParts parts = connected_parts(
        cells, [&](std::size_t i) { return cells[i] != kNone; },
        [&](std::size_t i, std::size_t j) { return cells[i] == cells[j] && square(i) == square(j); });
    Cells pieces(cells, kNone);
    pieces.values = std::move(parts.part.values);
    for (const std::size_t i : parts.first) pieces.face.push_back(cells.face[cells[i]]);
    return pieces;
}

// Each region as a cell, with the face of its first pixel.
Cells cells_of(const LabelImage& labels, const PixelMap& map) {
    Cells cells(labels);
    cells.values = labels.values;
    for (std::size_t i = 0; i < labels.size(); ++i)
        if (labels[i] == cells.count()) cells.face.push_back(map[i].face);
    return cells;
}

}  // namespace

Segmentation superpixels(const Level& level, const Cells& patches, const FeatureImage& image,
                         const SegmentParams& params, const Progress& progress) {
    const auto tell = [&](double fraction, std::string_view stage) {
        if (progress) progress(fraction, stage);
    };
    tell(0.1, "merge");
    const auto pixels =
        double(std::count_if(patches.begin(), patches.end(), [](Id cell) { return cell != kNone; }));
    const auto number = double(*params.superpixels);
    const double spacing = std::sqrt(pixels / number);
    const RegionDistance distance = superpixel_distance(params.compactness, spacing);
    const FeatureImage clean = clean_edges(blur_inside(image, patches), patches);
    const auto merged = [&](const Cells& cells, std::int64_t min_size, std::size_t least) {
        return merge_regions(region_graph(cells, level.map, clean, {}), distance, min_size, least);
    };
    const auto refine = [&](LabelImage& labels, std::int64_t min_size) {
        refine_outlines(labels, clean, {params.compactness, spacing, min_size});
        return cells_of(labels, level.map);
    };
    const bool few = double(patches.count()) < double(kPartsEach) * number;
    Cells cells = few ? cut_along_squares(patches, std::max(1, static_cast<int>(spacing / 2))) : patches;
    const std::size_t wanted = std::min(as_index(*params.superpixels), cells.size());
    Hierarchy hierarchy = merged(cells, 1, kPartsEach * wanted);
    LabelImage parts = labels_after(cells, hierarchy, hierarchy.merges.size());
    tell(0.4, "outlines");
    cells = refine(parts, 1);

    tell(0.6, "merge");
    hierarchy = merged(cells, params.min_size, wanted);
    Segmentation result;
    result.labels =
        labels_after(cells, hierarchy,
                     merges_to_count(hierarchy, *params.superpixels,
                                     cat(pixels, pixels == 1 ? " pixel" : " pixels"), result.missed));
    tell(0.7, "outlines");
    result.cells = refine(result.labels, params.min_size);
    tell(0.9, "merge");
    result.hierarchy = merged(result.cells, params.min_size, 1);
    tell(1, "done");
    return result;
}

}  // namespace imgmesh
