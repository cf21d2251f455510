#include "libcore/segment/segment.h"

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/segment/contour_hierarchy.h"
#include "libcore/segment/region_distance.h"
#include "libcore/segment/segment_rules.h"
#include "libcore/segment/superpixels.h"

namespace imgmesh {

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
    check_rules(params);
    check_picture(level, image);
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
    result.merges = wanted_merges(
        result.hierarchy, params,
        cat(result.hierarchy.cells, " connected patches, of which a mesh with more faces has more"),
        result.missed);
    result.labels = labels_after(result.cells, result.hierarchy, result.merges);
    tell(1, "done");
    return result;
}

}  // namespace imgmesh
