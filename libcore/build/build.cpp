#include "libcore/build/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/stopwatch.h"
#include "libcore/build/params.h"
#include "libcore/build/refine_level.h"
#include "libcore/build/rms_search.h"
#include "libcore/build/tracking.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/image/color.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/param/trivial_map.h"

namespace imgmesh {
namespace {

// The channels that the mesh is made from, as the file has them.
std::vector<std::string> used_channels(const Image& image, const std::vector<ChannelChoice>& choices) {
    if (choices.empty()) return split_names(image.channel_names).color;
    std::vector<std::string> names;
    for (const ChannelChoice& choice : choices) names.push_back(choice.name);
    return names;
}

// Features as a reader gets them: colours without their weight on the colours' grid, other channels in their
// own unit.
void take_weights_out(BaseMesh& mesh, const FeatureSpace& space) {
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        float* f = mesh.feature_of(v);
        for (int c = 0; c < space.features(); ++c) f[c] /= space.weight(c);
        if (!space.color || space.color_weight == 1) continue;
        const Vec3f color = storable_color(Vec3f(f), space.gamut);
        std::copy(color.data(), color.data() + 3, f);
    }
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
    const FeatureSpace& space;
    const Mask& mask;
    const BuildParams& params;
    BuildReport& report;
    const Progress& progress;

    std::vector<CollapseResult> collapse(const GridMesh& grid, const CollapseParams& limits,
                                         std::span<const CollapseTarget> targets,
                                         const CollapseHooks& hooks = {}) const {
        Stopwatch watch;
        std::vector<CollapseResult> collapsed =
            collapse_edges(grid, limits, targets, part_of(progress, 0, 0.7), hooks);
        report.seconds.collapse += watch.lap();
        return collapsed;
    }

    // Refinement, pixel map (`tracked` where there is one) and colours. Takes the share [begin, end] of the
    // progress.
    Level finish(CollapseResult&& collapsed, const CollapseParams& limits, std::optional<PixelMap> tracked,
                 LevelReport& figures, double begin, double end) const {
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
        fit.color_weight = map_color_weight(params);
        fit.bary = params.bary;
        fit.space = space;
        fit.keep_colors = params.quadric_colors || params.objective == Objective::kRgb;
        level.map = tracked ? fit_given_map(level.mesh, feature, *std::move(tracked), fit, mask)
                            : fit_map(level.mesh, feature, fit, part_of(progress, middle, end), mask);
        const PixelMap trivial = trivial_map(level.mesh, feature.width, feature.height, mask);
        figures = {map_rms(level.mesh, level.map, feature), map_rms(level.mesh, trivial, feature), {}};
        for (int c = space.color ? 3 : 0; c < space.features(); ++c)
            figures.plain_rms.push_back(feature_rms(level.mesh, level.map, feature, c) / space.weight(c));
        take_weights_out(level.mesh, space);
        report.seconds.map += watch.lap();
        return level;
    }
};

// Collapse and maps with the collapse's limits as they stand.
void build_levels(const Pipeline& pipeline, const CollapseParams& limits,
                  std::span<const CollapseTarget> targets, MeshImage& mesh_image) {
    Stopwatch watch;
    const GridMesh grid = grid_mesh(pipeline.feature, pipeline.mask);
    Tracking tracking(grid, pipeline.feature.width, pipeline.feature.height, pipeline.params);
    BuildReport& report = pipeline.report;
    report.seconds.collapse += watch.lap();
    std::vector<CollapseResult> collapsed = pipeline.collapse(grid, limits, targets, tracking.hooks());
    report.collapses = collapsed.back().collapses;
    report.retracted = tracking.retracted();
    report.levels.assign(collapsed.size(), {});
    mesh_image.visits = tracking.take_visits();
    mesh_image.levels.clear();
    for (std::size_t k = 0; k < collapsed.size(); ++k) {
        const double share = 0.3 / static_cast<double>(collapsed.size()),
                     begin = 0.7 + share * static_cast<double>(k);
        std::optional<PixelMap> tracked;
        if (tracking.tracked()) tracked = tracking.take_map(k);
        mesh_image.levels.push_back(pipeline.finish(std::move(collapsed[k]), limits, std::move(tracked),
                                                    report.levels[k], begin, begin + share));
    }
}

// The level that StopParams::rms asks for. Two runs of the collapse, of whose meshes only those that the
// search measures are finished.
void build_to_rms(const Pipeline& pipeline, CollapseParams limits, MeshImage& mesh_image) {
    const GridMesh grid = grid_mesh(pipeline.feature, pipeline.mask);
    const double rms = *pipeline.params.stop.rms;
    const auto pixels = static_cast<double>(pipeline.report.pixels);
    std::vector<CollapseResult> collapsed;
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
        collapsed = pipeline.collapse(grid, limits, targets);
        return [&](std::size_t k) {
            collapses = collapsed[k].collapses;
            level = pipeline.finish(std::move(collapsed[k]), limits, {}, figures, 0.7, 1);
            least = std::min(least, figures.map_rms);
            return figures.map_rms;
        };
    };
    mesh_image.levels.clear();
    // All of the dense mesh: strips of one pixel have more vertices than pixels.
    const auto vertices = grid.mask.empty()
                              ? static_cast<std::int64_t>(grid.vertex_count())
                              : pipeline.report.pixels + static_cast<std::int64_t>(grid.copies.size());
    search_rms(std::max(std::int64_t{4}, vertices), rms, run, [&] {
        mesh_image.levels.assign(1, std::move(level));
        pipeline.report.levels = {figures};
        pipeline.report.collapses = collapses;
    });
    if (mesh_image.levels.empty())
        throw Error(ErrorCode::kUnsupported,
                    cat("rms is ", rms, ", but the least that could be reached is ", least));
}

}  // namespace

BuildResult build_mesh_image(const Image& image, const BuildParams& asked, const Progress& progress,
                             Mask mask) {
    check_params(asked);
    if (image.width < 1 || image.height < 1) throw Error(ErrorCode::kUsage, "the picture is empty");
    for (const float sample : image.data)
        if (!std::isfinite(sample))
            throw Error(ErrorCode::kUnsupported, "the picture has samples that are not finite");
    mask = checked(std::move(mask), image);
    Stopwatch watch;
    // What lies outside of the colours that a container holds could only mislead the fit: L*u*v* of negative
    // light has no bound.
    const FeatureSpace space = feature_space(image, asked.channels, mask);
    const bool refinable =
        space.color && space.features() == 3 && space.color_weight == 1 && space.gamut == Gamut::kDisplay;
    BuildParams params = asked;
    if (!params.refine) params.refine = refinable ? refine_rounds(asked) : 0;
    if ((*params.refine > 0 || params.objective == Objective::kRgb) && !refinable)
        throw Error(ErrorCode::kUnsupported,
                    "refinement, which the presets best and fem bring along, is for colour alone, without "
                    "light above 1");
    const FeatureImage feature = extract_features(image, space, mask);

    BuildResult result;
    result.report.seconds.collapse = watch.lap();
    result.report.pixels = mask.empty() ? static_cast<std::int64_t>(image.pixel_count()) : mask.count();
    const auto pixels = static_cast<double>(result.report.pixels);
    const std::vector<CollapseTarget> targets = collapse_targets(params, pixels);
    CollapseParams collapse = collapse_params(params, targets.front(), pixels);
    const std::vector<Level>& levels = result.mesh_image.levels;
    if (params.max_cluster) collapse.max_face_area = static_cast<float>(*params.max_cluster);
    const Pipeline pipeline{feature, space, mask, params, result.report, progress};
    for (;;) {
        if (params.stop.rms)
            build_to_rms(pipeline, collapse, result.mesh_image);
        else
            build_levels(pipeline, collapse, targets, result.mesh_image);
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
    result.mesh_image.source = {image.width,
                                image.height,
                                image.color_space,
                                image.sample_type,
                                used_channels(image, params.channels),
                                !mask.empty(),
                                space.gamut};
    result.mesh_image.parameters = listed_params(params, collapse);
    const bool half = levels.front().map.precision == WeightPrecision::kHalf;
    result.mesh_image.parameters.emplace_back("bary", std::string(half ? "half" : "float"));
    if (progress) progress(1.0, "done");
    return result;
}

}  // namespace imgmesh
