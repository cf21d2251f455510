#include "libcore/pipeline/params.h"

#include <cmath>

#include "libcore/base/error.h"
#include "libcore/param/track.h"
#include "libcore/pipeline/param_table.h"

namespace imgmesh {
namespace {

void require(bool holds, const std::string& text) {
    if (!holds) throw Error(ErrorKind::kBadArgument, text);
}

// Smoother gradients help if vertices are far apart; figures in docs/paper-map.md.
int smoothing_passes(double pixels_per_vertex) {
    return pixels_per_vertex >= 250 ? 4 : pixels_per_vertex >= 66 ? 2 : pixels_per_vertex >= 12 ? 1 : 0;
}

}  // namespace

void check_params(const BuildParams& p) {
    check_channels(p.channels);
    check_ranges(p);
    require(!p.stop.rms || (p.levels.count == 1 && p.levels.faces.empty() && p.levels.errors.empty()),
            "rms stops at one level, and more are asked for");
    require(!p.stop.rms || (map_kind(p) != MapKind::kTracked && !p.visits),
            "rms is searched over several meshes, a tracked map and visits follow the collapse to one");
    // Quadrics are single precision: products of two sums over all pixels must neither overflow nor vanish.
    const double lambda = p.geometry_weight / p.color_weight;
    require(lambda >= 1e-9 && lambda <= 1e9,
            cat("geometry-weight / color-weight is ", lambda, ", expected 1e-9 to 1e9"));
    const double projection = p.projection_color_weight.value_or(1);
    require(projection > 0 || p.map.value_or(MapKind::kTrivial) == MapKind::kTrivial,
            "projection-color-weight 0 is the trivial map, not a tracked or relaxed one");
    require(!p.projection_color_weight || projection == 0 ||
                p.map.value_or(MapKind::kRelaxed) != MapKind::kTrivial,
            cat("the trivial map has projection-color-weight 0, not ", projection));
    require(
        map_kind(p) != MapKind::kTracked || p.refine.value_or(0) == 0,
        cat("a tracked map follows the collapse alone: refine is ", p.refine.value_or(0), ", expected 0"));
    require(
        map_kind(p) != MapKind::kTracked || (p.mesh_precision == MeshPrecision::kExact && !p.position_step),
        "a tracked map follows the collapse alone: mesh-precision compact and position-step would move "
        "its vertices");
    require(!p.quadric_colors || (p.refine.value_or(0) == 0 && p.objective == Objective::kLuv),
            "colors are the quadrics', but refinement and the objective rgb fit their own: expected refine 0 "
            "and objective luv");
    require(p.levels.faces.size() <= kMaxLevels && p.levels.errors.size() <= kMaxLevels,
            cat("there are more than ", kMaxLevels, " levels"));
    for (std::size_t k = 1; k < p.levels.faces.size(); ++k)
        require(p.levels.faces[k] < p.levels.faces[k - 1],
                cat("level-faces of level ", k, " is ", p.levels.faces[k],
                    ", expected less than the level before"));
    for (std::size_t k = 1; k < p.levels.errors.size(); ++k)
        require(p.levels.errors[k] > p.levels.errors[k - 1],
                cat("level-errors of level ", k, " is ", p.levels.errors[k],
                    ", expected more than the level before"));
}

MapKind map_kind(const BuildParams& p) {
    return p.map.value_or(p.projection_color_weight == 0.0 ? MapKind::kTrivial : MapKind::kRelaxed);
}

double map_color_weight(const BuildParams& p) {
    switch (map_kind(p)) {
        case MapKind::kTrivial:
            return 0;
        case MapKind::kTracked:
            return p.projection_color_weight.value_or(TrackParams().color_weight);
        case MapKind::kRelaxed:
            break;
    }
    return p.projection_color_weight.value_or(FitParams().color_weight);
}

std::vector<SimplifyTarget> collapse_targets(const BuildParams& params, double pixels) {
    std::vector<SimplifyTarget> targets;
    for (const std::int64_t faces : params.levels.faces) targets.push_back({.faces = faces});
    for (const double error : params.levels.errors)
        targets.push_back({.max_error = error / params.color_weight});
    if (!targets.empty()) return targets;

    SimplifyTarget finest;
    const StopParams& stop = params.stop;
    finest.faces = stop.faces.value_or(0);
    finest.vertices = stop.vertices.value_or(0);
    if (stop.error) finest.max_error = *stop.error / params.color_weight;
    if (!stop.faces && !stop.vertices && !stop.error)
        finest.vertices =
            std::max(std::int64_t{4}, static_cast<std::int64_t>(std::llround(pixels * stop.density / 100)));
    targets.push_back(finest);
    for (int k = 1; k < params.levels.count; ++k) targets.push_back({.faces = 2, .face_share = 0.25});
    return targets;
}

SimplifyParams collapse_params(const BuildParams& params, const SimplifyTarget& finest, double pixels) {
    SimplifyParams out;
    out.metric = params.metric;
    out.solver = params.solver;
    out.geometry_weight = static_cast<float>(params.geometry_weight / params.color_weight);
    out.rebuild_quadrics = params.rebuild_quadrics;
    out.tiles = map_kind(params) != MapKind::kTracked && !params.visits;
    // Ordering by what merges add, and smoothing, are not part of what others published.
    const bool published = params.metric != Metric::kFlattened;
    out.total_priority = params.total_priority.value_or(published);
    out.min_shape = static_cast<float>(params.min_quality);
    const auto vertices = static_cast<double>(std::max(finest.vertices, finest.faces / 2));
    // If only an error is given, the density is unknown beforehand; the default's is used.
    const int passes = published ? 0 : smoothing_passes(vertices > 0 ? pixels / vertices : 100);
    out.smoothing = params.smoothing.value_or(passes);
    return out;
}

std::int64_t refine_rounds(const BuildParams& params) {
    const bool plain =
        params.metric != Metric::kFlattened || params.quadric_colors || map_kind(params) == MapKind::kTracked;
    return params.refine.value_or(plain ? 0 : RefineParams().rounds);
}

BuildParams closed_params(const BuildParams& params, const SimplifyParams& collapse,
                          WeightPrecision precision) {
    BuildParams out = params;
    out.total_priority = collapse.total_priority;
    out.smoothing = collapse.smoothing;
    out.refine = refine_rounds(params);
    out.map = map_kind(params);
    out.projection_color_weight = map_color_weight(params);
    out.bary = precision;
    return out;
}

RefineParams refine_params(const BuildParams& p) {
    RefineParams refine;
    refine.rounds = static_cast<int>(refine_rounds(p));
    refine.shape_weight = p.shape_weight;
    refine.exchange = p.exchange;
    refine.anneal = static_cast<int>(p.anneal);
    refine.keep_faces = p.stop.faces || p.levels.count > 1 || !p.levels.faces.empty();
    refine.min_quality = p.min_quality;
    return refine;
}

FitParams fit_params(const BuildParams& p, const FeatureSpace& space) {
    FitParams fit;
    fit.color_weight = map_color_weight(p);
    fit.bary = p.bary;
    fit.steps = p.map_steps;
    fit.rounds = static_cast<int>(p.map_rounds);
    fit.rate = p.map_rate;
    fit.space = space;
    fit.keep_colors = p.quadric_colors || p.objective == Objective::kRgb;
    return fit;
}

}  // namespace imgmesh
