#include "libcore/pipeline/build_stages.h"

#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/stopwatch.h"
#include "libcore/mesh/round_positions.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/pipeline/lean_mesh.h"
#include "libcore/pipeline/level_colors.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/refine_level.h"
#include "libcore/pipeline/tracking.h"

namespace imgmesh {

Progress part_of(const Progress& whole, double begin, double end) {
    if (!whole) return {};
    return [=](double f, std::string_view stage) { whole(begin + f * (end - begin), stage); };
}

std::vector<SimplifyResult> BuildStages::collapse(const SimplifyParams& limits,
                                                  std::span<const SimplifyTarget> targets,
                                                  const SimplifyHooks& hooks) const {
    Stopwatch watch;
    std::vector<SimplifyResult> collapsed = simplify(grid, limits, targets, part_of(progress, 0, 0.7), hooks);
    report.seconds.collapse += watch.lap();
    return collapsed;
}

void BuildStages::set_sides(BaseMesh& mesh) const {
    // Where a mask leaves strips one pixel wide, vertices are half a pixel beside the sides' pixels.
    if (sides && !set_side_features(mesh, *sides, feature) && mask.empty())
        throw Error(ErrorKind::kInternal, "a tile has a vertex on its sides that is not the sides'");
}

Level BuildStages::finish(SimplifyResult&& collapsed, const SimplifyParams& limits,
                          std::optional<PixelMap> tracked, LevelReport& figures, double begin,
                          double end) const {
    Stopwatch watch;
    RefineParams refinement = refine_params(params);
    refinement.max_face_area = limits.max_face_area;
    const double unit = static_cast<double>(space.unit);
    Level level{std::move(collapsed.mesh), {}, collapsed.error * params.color_weight / (unit * unit)};
    refinement.keep_sides = sides != nullptr;
    set_sides(level.mesh);
    const double middle = refinement.rounds > 0 ? begin + 0.7 * (end - begin) : begin;
    if (refinement.rounds > 0 || params.objective == Objective::kRgb)
        refine_level(level.mesh, feature, mask, params.objective, refinement,
                     part_of(progress, begin, middle));
    figures.position_step = position_step(params, report.pixels, level.mesh.vertex_count());
    if (figures.position_step > double{kPositionStep}) {
        refinement.position_step = static_cast<float>(figures.position_step);
        figures.fine_vertices = round_positions(level.mesh, refinement.position_step, params.min_quality,
                                                sides ? &feature : nullptr);
        if (refinement.rounds > 0) {
            // One round on the grid makes good what the rounding has cost.
            refinement.rounds = 1;
            refinement.relocations = 0;
            refinement.anneal = 0;
            refine_level(level.mesh, feature, mask, params.objective, refinement, {});
        }
    }
    set_sides(level.mesh);
    report.seconds.refine += watch.lap();
    FitParams fit = fit_params(params, space);
    fit.sides = sides;
    const bool left_out = params.map_is_left_out && !tracked;
    if (left_out)
        level.map = fit_drawing(level.mesh, feature, fit, mask);
    else
        level.map = tracked ? fit_given_map(level.mesh, feature, *std::move(tracked), fit, mask)
                            : fit_map(level.mesh, feature, fit, part_of(progress, middle, end), mask);
    const PixelMap trivial =
        left_out ? PixelMap() : trivial_map(level.mesh, feature.width, feature.height, mask);
    const PixelMap& drawing = left_out ? level.map : trivial;
    figures.color_levels = round_colors(params, level.mesh, feature, space, level.map, drawing, fit);
    limit_alpha(level.mesh, feature, space, mask);
    set_sides(level.mesh);
    figures.map_rms = map_rms(level.mesh, level.map, feature);
    figures.gouraud_rms = left_out ? figures.map_rms : map_rms(level.mesh, trivial, feature);
    figures.auxiliary_rms.clear();
    for (int c = space.color ? 3 : 0; c < space.features(); ++c)
        figures.auxiliary_rms.push_back(feature_rms(level.mesh, level.map, feature, c) / space.weight(c));
    figures.map_rms /= unit;
    figures.gouraud_rms /= unit;
    take_weights_out(level.mesh, space);
    report.seconds.map += watch.lap();
    return level;
}

double BuildStages::estimated_rms(SimplifyResult&& collapsed) const {
    Stopwatch watch;
    FitParams fit = fit_params(params, space);
    fit.rounds = 1;
    fit.bary = WeightPrecision::kFloat;
    fit.keep_colors = false;
    const PixelMap map = fit_map(collapsed.mesh, feature, fit, {}, mask);
    const double rms = map_rms(collapsed.mesh, map, feature);
    report.seconds.map += watch.lap();
    return rms;
}

void build_levels(const BuildStages& stages, const SimplifyParams& limits,
                  std::span<const SimplifyTarget> targets, MeshImage& mesh_image) {
    Stopwatch watch;
    Tracking tracking(stages.grid, stages.feature.width, stages.feature.height, stages.params);
    BuildReport& report = stages.report;
    report.seconds.collapse += watch.lap();
    std::vector<SimplifyResult> collapsed = stages.collapse(limits, targets, tracking.hooks());
    report.collapses = collapsed.back().collapses;
    report.rejected = tracking.rejected();
    mesh_image.visits = tracking.take_visits();
    mesh_image.levels.clear();
    report.levels.clear();
    // Each collapse takes a vertex: with as many as the level before, a level has the same mesh.
    std::vector<std::size_t> kept;
    for (std::size_t k = 0; k < collapsed.size(); ++k)
        if (k == 0 || collapsed[k].mesh.vertex_count() != collapsed[kept.back()].mesh.vertex_count())
            kept.push_back(k);
    for (const std::size_t k : kept) {
        const double share = 0.3 / static_cast<double>(kept.size()),
                     begin = 0.7 + share * static_cast<double>(report.levels.size());
        std::optional<PixelMap> tracked;
        if (tracking.tracked()) tracked = tracking.take_map(k);
        LevelReport& figures = report.levels.emplace_back();
        mesh_image.levels.push_back(stages.finish(std::move(collapsed[k]), limits, std::move(tracked),
                                                  figures, begin, begin + share));
        figures.target = k;
    }
}

}  // namespace imgmesh
