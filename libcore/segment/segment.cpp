#include "libcore/segment/segment.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/segment/contour_hierarchy.h"
#include "libcore/segment/region_distance.h"
#include "libcore/segment/superpixels.h"

namespace imgmesh {
namespace {

void check(const Level& level, const FeatureImage& image, const SegmentParams& params) {
    const auto fail = [](const std::string& text) { throw Error(ErrorKind::kBadArgument, text); };
    if (!(params.threshold > 0 && std::isfinite(params.threshold)))
        fail(cat("threshold is ", params.threshold, ", expected above 0"));
    if (params.segments && params.superpixels) fail("segments and superpixels exclude each other");
    if (params.clearest && (params.segments || params.superpixels))
        fail("the clearest regions, and a number of segments or superpixels exclude each other");
    if (params.segments && *params.segments < 1)
        fail(cat("segments is ", *params.segments, ", expected at least 1"));
    if (params.superpixels && *params.superpixels < 1)
        fail(cat("superpixels is ", *params.superpixels, ", expected at least 1"));
    if (!(params.compactness >= 0 && std::isfinite(params.compactness)))
        fail(cat("compactness is ", params.compactness, ", expected at least 0"));
    if (params.min_size < 1) fail(cat("the least size is ", params.min_size, ", expected at least 1"));
    if (image.width != level.map.width || image.height != level.map.height)
        fail(cat("the image has ", image.width, "x", image.height, " pixels, the container ", level.map.width,
                 "x", level.map.height));
    if (image.channels != 3)
        throw Error(ErrorKind::kUnsupported,
                    cat("the image has ", image.channels, " channels, expected L*, u*, v*"));
}

}  // namespace

FeatureImage reconstruct_luv(const Level& level) {
    if (level.mesh.channels < 3)
        throw Error(ErrorKind::kUnsupported, cat("the base mesh has ", level.mesh.channels,
                                                 " channels, expected colour as L*, u*, v*"));
    FeatureImage image(level.map.width, level.map.height, 3, std::vector<float>(level.map.size() * 3));
    for (std::size_t i = 0; i < level.map.size(); ++i) {
        const PixelCoord& coord = level.map[i];
        if (coord.face == kNone) continue;
        const auto [a, b, c] = level.mesh.faces[coord.face];
        const auto color = [&](Id v) { return Eigen::Map<const Vec3f>(level.mesh.feature_of(v)); };
        Eigen::Map<Vec3f>(image.pixel(i)) =
            (1 - coord.u - coord.v) * color(a) + coord.u * color(b) + coord.v * color(c);
    }
    return image;
}

Segmentation segment(const Level& level, const FeatureImage& image, const SegmentParams& params,
                     const Progress& progress) {
    check(level, image, params);
    const auto tell = [&](double fraction, std::string_view stage) {
        if (progress) progress(fraction, stage);
    };
    if (std::all_of(level.map.begin(), level.map.end(), [](const PixelCoord& c) { return c.face == kNone; }))
        throw Error(ErrorKind::kUnsupported, "every pixel is outside the mask");
    if (params.superpixels) return superpixels(level, cut_cells(level.map), image, params, progress);

    Segmentation result;
    if (params.distance == DistanceRule::kContour) {
        CellHierarchy merged = contour_hierarchy(level.map, image, params.quality, params.min_size, progress);
        result.cells = std::move(merged.cells);
        result.hierarchy = std::move(merged.hierarchy);
    } else {
        tell(0, "merge");
        result.cells = cut_cells(level.map);
        result.hierarchy = merge_regions(region_graph(result.cells, level.map, image, {}), paper_distance(),
                                         params.min_size);
    }
    if (params.segments)
        result.merges = merges_to_count(
            result.hierarchy, *params.segments,
            cat(result.hierarchy.cells, " connected patches, of which a mesh with more faces has more"),
            result.missed);
    else if (params.clearest)
        result.merges = clearest_merges(result.hierarchy, params.threshold / kClearestRange,
                                        params.threshold * kClearestRange);
    else
        result.merges = merges_below(result.hierarchy, params.threshold);
    result.labels = labels_after(result.cells, result.hierarchy, result.merges);
    tell(1, "done");
    return result;
}

}  // namespace imgmesh
