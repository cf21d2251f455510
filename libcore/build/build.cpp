#include "libcore/build/build.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/build/params.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/image/color.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/param/track.h"
#include "libcore/param/track_start.h"
#include "libcore/param/trivial_map.h"

namespace imgmesh {
namespace {

// The colour channels that the mesh was made from, as the file had them.
std::vector<std::string> color_channels(const Image& image) {
    return image.channel("R") >= 0 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
}

// A part [begin, end] of the whole, as a progress of its own.
Progress part_of(const Progress& whole, double begin, double end) {
    if (!whole) return {};
    return [=](double f, std::string_view stage) { whole(begin + f * (end - begin), stage); };
}

std::int64_t largest_patch(const Level& level) {
    std::vector<std::int64_t> pixels(level.mesh.faces.size(), 0);
    for (const PixelCoord& coord : level.map.coords)
        if (coord.face != kNone) ++pixels[coord.face];
    return *std::max_element(pixels.begin(), pixels.end());
}

// Follows the collapse with a tracker, where map or visits need one.
struct Tracking {
    std::optional<PixelTracker> tracker;
    std::vector<PixelMap> maps;  // of each level
    std::vector<Id> visits;      // down to the finest level

    CollapseHooks hooks() {
        if (!tracker) return {};
        return {[this](const CollapseStep& step) {
                    return tracker->collapse(step.kept, step.gone, {step.x, step.y}, step.feature);
                },
                [this](std::size_t level, const CollapseResult& result) {
                    maps.push_back(tracker->map(result.mesh));
                    if (level == 0) visits = tracker->visits();
                }};
    }
};

// Collapse and maps with the collapse's limits as they stand.
void build_levels(const FeatureImage& feature, const BuildParams& params, const CollapseParams& collapse,
                  std::span<const CollapseTarget> targets, BuildResult& result, const Progress& progress) {
    const bool tracked = map_kind(params) == MapKind::kTracked;
    const GridMesh grid = grid_mesh(feature);
    Tracking tracking;
    if (tracked || params.visits) {
        // Visits alone must not change the mesh: pixels then stay where they are, which forbids nothing.
        TrackParams track;
        track.space = tracked ? TrackSpace::kConformal : TrackSpace::kPlane;
        track.color_weight = tracked ? map_color_weight(params) : 0;
        tracking.tracker.emplace(track_start(grid, feature.width, feature.height), track);
    }
    std::vector<CollapseResult> collapsed =
        collapse_edges(grid, collapse, targets, part_of(progress, 0, 0.7), tracking.hooks());
    FitParams fit;
    fit.color_weight = map_color_weight(params);
    fit.bary = params.bary;
    BuildReport& report = result.report;
    report = {collapsed.back().collapses, tracking.tracker ? tracking.tracker->retracted() : 0, {}};
    result.mesh_image.visits = params.visits ? std::move(tracking.visits) : std::vector<Id>{};
    std::vector<Level>& levels = result.mesh_image.levels;
    levels.clear();
    for (std::size_t k = 0; k < collapsed.size(); ++k) {
        Level level{std::move(collapsed[k].mesh), {}, collapsed[k].error * params.color_weight};
        const double share = 0.3 / static_cast<double>(collapsed.size()),
                     begin = 0.7 + share * static_cast<double>(k);
        level.map = tracked ? fit_given_map(level.mesh, feature, std::move(tracking.maps[k]), fit)
                            : fit_map(level.mesh, feature, fit, part_of(progress, begin, begin + share));
        const PixelMap trivial = trivial_map(level.mesh, feature.width, feature.height);
        report.levels.push_back(
            {map_rms(level.mesh, level.map, feature), map_rms(level.mesh, trivial, feature)});
        levels.push_back(std::move(level));
    }
}

}  // namespace

BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress) {
    check_params(params);
    if (image.width < 1 || image.height < 1) throw Error(ErrorCode::kUsage, "the picture is empty");
    for (const float sample : image.data)
        if (!std::isfinite(sample))
            throw Error(ErrorCode::kUnsupported, "the picture has samples that are not finite");
    // A container's colours are codes of [0, 1]. What lies outside could only mislead the fit: L*u*v* of
    // negative light has no bound.
    const FeatureImage feature = luv_image(image, Range::kClipped);

    const auto pixels = static_cast<double>(image.pixel_count());
    const std::vector<CollapseTarget> targets = collapse_targets(params, pixels);
    CollapseParams collapse = collapse_params(params, targets.front(), pixels);
    BuildResult result;
    const std::vector<Level>& levels = result.mesh_image.levels;
    if (params.max_cluster) collapse.max_face_area = static_cast<float>(*params.max_cluster);
    for (;;) {
        build_levels(feature, params, collapse, targets, result, progress);
        if (!params.max_cluster) break;
        // The collapse bounds a face's area; the map decides how many pixels that becomes.
        std::int64_t largest = 0;
        for (const Level& level : levels) largest = std::max(largest, largest_patch(level));
        if (largest <= *params.max_cluster) break;
        if (collapse.max_face_area < 0.5f)
            throw Error(ErrorCode::kUnsupported, cat("the map gathers ", largest,
                                                     " pixels in a face of the dense mesh, more than the ",
                                                     *params.max_cluster, " allowed"));
        collapse.max_face_area *=
            0.95f * static_cast<float>(*params.max_cluster) / static_cast<float>(largest);
    }
    result.mesh_image.source = {image.width,       image.height,          image.color_space,
                                image.sample_type, color_channels(image), false};
    result.mesh_image.parameters = listed_params(params, collapse);
    const bool half = levels.front().map.precision == WeightPrecision::kHalf;
    result.mesh_image.parameters.emplace_back("bary", std::string(half ? "half" : "float"));
    if (progress) progress(1.0, "done");
    return result;
}

}  // namespace imgmesh
