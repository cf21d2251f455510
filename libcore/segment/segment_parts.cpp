#include "libcore/segment/segment_parts.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/segment/contour_hierarchy.h"
#include "libcore/segment/first_regions.h"
#include "libcore/segment/merge_regions.h"
#include "libcore/segment/part_contours.h"
#include "libcore/segment/region_distance.h"
#include "libcore/segment/segment_rules.h"

namespace imgmesh {

double part_memory(const PartGrid& grid, const SegmentParams& params) {
    constexpr double kRegionBytes = 700;              // of its sums, borders and candidates for merges
    constexpr double kRunBytes = 30;                  // of both stages' labels
    constexpr double kMarginBytes = 3 * 4 * 17 * 13;  // of three rows of parts, for each column of pixels
    constexpr double kSmallBytes = 60;                // of a pixel at which contours are measured
    const GridSize size = grid.size();
    const double pixels = double(size.pixel_count());
    double regions = 0;
    for (int row = 0; row < grid.rows(); ++row)
        for (int column = 0; column < grid.columns(); ++column) {
            const PixelRect rect = grid.rect(column, row);
            regions += double(fine_regions(double(rect.width()) * rect.height(), pixels, params));
        }
    regions = std::min(regions, pixels);
    const double factor = disc_factor(size);
    // A region of a thousand pixels has some thirty rows, hence the root.
    return kRegionBytes * regions + kRunBytes * std::sqrt(pixels * regions) + kMarginBytes * size.width +
           kSmallBytes * pixels / (factor * factor) + contour_memory(size);
}

PartSegmentation segment_parts(const PictureParts& picture, const SegmentParams& params,
                               const Progress& progress) {
    check_rules(params);
    if (params.superpixels) throw Error(ErrorKind::kUnsupported, "superpixels of a picture in parts");
    const auto part_of_progress = [&](double from, double share) {
        return [&progress, from, share](double fraction, std::string_view stage) {
            if (progress) progress(from + share * fraction, stage);
        };
    };
    const bool contour = params.distance == DistanceRule::kContour;
    const bool measured = contour && params.quality != SegmentQuality::kFast;
    const int factor = disc_factor(picture.grid.size());
    SmallImageSums small(measured ? picture.grid.size() : GridSize{}, factor);
    FirstRegions first = first_regions(picture, params, measured ? &small : nullptr,
                                       part_of_progress(0, measured ? 0.7 : 0.9));
    if (first.graph.regions.empty()) throw Error(ErrorKind::kUnsupported, "every pixel is outside the mask");
    double pixels = 0;
    for (const RegionSums& sums : first.graph.regions) pixels += sums.pixels;

    const RegionDistance distance = contour ? contour_distance(pixels) : paper_distance();
    PartSegmentation result{std::move(first.labels), 0, first.cells, {}, 0, {}};
    if (measured) {
        // With fewer regions than are wanted, the second stage could not leave so many.
        const std::size_t wanted =
            std::min(first.graph.regions.size(), as_index(params.segments.value_or(0)));
        const std::size_t least = std::max(kFirstRegions, 2 * wanted);
        MergedRegions merged = merge_to(std::move(first.graph), distance, least);
        result.labels.renumber(regions_after(merged.hierarchy, merged.hierarchy.merges.size()));
        RegionGraph graph =
            contour_graph(picture, result.labels, merged.graph.regions.size(), smoothing_radius(pixels),
                          small.finish(), part_of_progress(0.7, 0.25));
        result.hierarchy = merge_regions(std::move(graph), distance, params.min_size);
    } else {
        result.hierarchy = merge_regions(std::move(first.graph), distance, params.min_size);
    }
    if (contour) scale_heights(result.hierarchy);
    result.merges = wanted_merges(result.hierarchy, params, "the regions of its parts", result.missed);
    result.count = result.hierarchy.cells - result.merges;
    result.labels.renumber(regions_after(result.hierarchy, result.merges));
    if (progress) progress(1, "done");
    return result;
}

}  // namespace imgmesh
