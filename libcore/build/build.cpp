#include "libcore/build/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/stopwatch.h"
#include "libcore/build/params.h"
#include "libcore/build/refine_level.h"
#include "libcore/build/rms_search.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/image/color.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
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

// Empty where all pixels are inside.
Mask checked(Mask mask, const Image& image) {
    if (mask.empty()) return mask;
    if (mask.width != image.width || mask.height != image.height)
        throw Error(ErrorCode::kBadFile, cat("the mask is ", mask.width, "x", mask.height,
                                             ", the picture is ", image.width, "x", image.height));
    const std::int64_t inside = mask.count();
    if (inside == 0) throw Error(ErrorCode::kUnsupported, "no pixel is inside the mask");
    if (inside == static_cast<std::int64_t>(image.pixel_count())) return {};
    return mask;
}

// What makes levels of collapsed meshes.
struct Pipeline {
    const FeatureImage& feature;
    const Mask& mask;
    const BuildParams& params;
    BuildReport& report;
    const Progress& progress;

    std::vector<CollapseResult> collapse(const CollapseParams& limits,
                                         std::span<const CollapseTarget> targets) const {
        Stopwatch watch;
        std::vector<CollapseResult> collapsed =
            collapse_edges(grid_mesh(feature, mask), limits, targets, part_of(progress, 0, 0.7));
        report.seconds.collapse += watch.lap();
        return collapsed;
    }

    // Refinement, pixel map and colours. Takes the share [begin, end] of the progress.
    Level finish(CollapseResult&& collapsed, const CollapseParams& limits, LevelReport& figures, double begin,
                 double end) const {
        Stopwatch watch;
        RefineParams refinement;
        refinement.rounds = static_cast<int>(refine_rounds(params));
        refinement.shape_weight = params.shape_weight;
        refinement.exchange = params.exchange;
        refinement.min_quality = params.min_quality;
        refinement.max_face_area = limits.max_face_area;
        Level level{std::move(collapsed.mesh), {}, collapsed.error * params.color_weight};
        const double middle = refinement.rounds > 0 ? begin + 0.7 * (end - begin) : begin;
        if (refinement.rounds > 0 || params.objective == Objective::kRgb)
            refine_level(level.mesh, feature, mask, params.objective, refinement,
                         part_of(progress, begin, middle));
        report.seconds.refine += watch.lap();
        FitParams fit;
        fit.color_weight = params.projection_color_weight;
        fit.bary = params.bary;
        fit.keep_colors = params.quadric_colors || params.objective == Objective::kRgb;
        level.map = fit_map(level.mesh, feature, fit, part_of(progress, middle, end), mask);
        const PixelMap trivial = trivial_map(level.mesh, feature.width, feature.height, mask);
        figures = {map_rms(level.mesh, level.map, feature), map_rms(level.mesh, trivial, feature)};
        report.seconds.map += watch.lap();
        return level;
    }
};

// Collapse and maps with the collapse's limits as they stand.
std::vector<Level> build_levels(const Pipeline& pipeline, const CollapseParams& limits,
                                std::span<const CollapseTarget> targets) {
    std::vector<CollapseResult> collapsed = pipeline.collapse(limits, targets);
    BuildReport& report = pipeline.report;
    report.collapses = collapsed.back().collapses;
    report.levels.assign(collapsed.size(), {});
    std::vector<Level> levels;
    for (std::size_t k = 0; k < collapsed.size(); ++k) {
        const double share = 0.3 / static_cast<double>(collapsed.size()),
                     begin = 0.7 + share * static_cast<double>(k);
        levels.push_back(
            pipeline.finish(std::move(collapsed[k]), limits, report.levels[k], begin, begin + share));
    }
    return levels;
}

// The level that StopParams::rms asks for. Two runs of the collapse, of whose meshes only those that the
// search measures are finished.
std::vector<Level> build_to_rms(const Pipeline& pipeline, CollapseParams limits) {
    const double rms = *pipeline.params.stop.rms;
    const auto pixels = static_cast<double>(pipeline.report.pixels);
    std::vector<CollapseResult> collapsed;
    std::vector<Level> best;
    Level level;
    LevelReport figures;
    std::int64_t collapses = 0;
    double least = std::numeric_limits<double>::infinity();
    const auto run = [&](const std::vector<std::int64_t>& counts) {
        std::vector<CollapseTarget> targets;
        for (const std::int64_t count : counts) targets.push_back({.vertices = count});
        limits.smoothing =
            collapse_params(pipeline.params, targets[std::min<std::size_t>(7, targets.size() - 1)], pixels)
                .smoothing;
        collapsed = pipeline.collapse(limits, targets);
        return [&](std::size_t k) {
            collapses = collapsed[k].collapses;
            level = pipeline.finish(std::move(collapsed[k]), limits, figures, 0.7, 1);
            least = std::min(least, figures.map_rms);
            return figures.map_rms;
        };
    };
    search_rms(std::max(std::int64_t{4}, pipeline.report.pixels), rms, run, [&] {
        best.assign(1, std::move(level));
        pipeline.report.levels = {figures};
        pipeline.report.collapses = collapses;
    });
    if (best.empty())
        throw Error(ErrorCode::kUnsupported,
                    cat("rms is ", rms, ", but the least that could be reached is ", least));
    return best;
}

}  // namespace

BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress,
                             Mask mask) {
    check_params(params);
    if (image.width < 1 || image.height < 1) throw Error(ErrorCode::kUsage, "the picture is empty");
    for (const float sample : image.data)
        if (!std::isfinite(sample))
            throw Error(ErrorCode::kUnsupported, "the picture has samples that are not finite");
    // A container's colours are codes of [0, 1]. What lies outside could only mislead the fit: L*u*v* of
    // negative light has no bound.
    Stopwatch watch;
    const FeatureImage feature = luv_image(image, Range::kClipped);

    mask = checked(std::move(mask), image);
    BuildResult result;
    result.report.seconds.collapse = watch.lap();
    result.report.pixels = mask.empty() ? static_cast<std::int64_t>(image.pixel_count()) : mask.count();
    const auto pixels = static_cast<double>(result.report.pixels);
    const std::vector<CollapseTarget> targets = collapse_targets(params, pixels);
    CollapseParams collapse = collapse_params(params, targets.front(), pixels);
    std::vector<Level>& levels = result.mesh_image.levels;
    if (params.max_cluster) collapse.max_face_area = static_cast<float>(*params.max_cluster);
    const Pipeline pipeline{feature, mask, params, result.report, progress};
    for (;;) {
        levels =
            params.stop.rms ? build_to_rms(pipeline, collapse) : build_levels(pipeline, collapse, targets);
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
                                image.sample_type, color_channels(image), !mask.empty()};
    result.mesh_image.parameters = listed_params(params, collapse);
    const bool half = levels.front().map.precision == WeightPrecision::kHalf;
    result.mesh_image.parameters.emplace_back("bary", std::string(half ? "half" : "float"));
    if (progress) progress(1.0, "done");
    return result;
}

}  // namespace imgmesh
