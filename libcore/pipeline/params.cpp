#include "libcore/pipeline/params.h"

#include <cmath>
#include <sstream>

#include "libcore/base/error.h"
#include "libcore/param/track.h"

namespace imgmesh {
namespace {

void require(bool holds, const std::string& text) {
    if (!holds) throw Error(ErrorKind::kBadArgument, text);
}

// Smoother gradients pay where vertices are far apart; figures in docs/paper-map.md.
int smoothing_passes(double pixels_per_vertex) {
    return pixels_per_vertex >= 250 ? 4 : pixels_per_vertex >= 66 ? 2 : pixels_per_vertex >= 12 ? 1 : 0;
}

std::ostream& operator<<(std::ostream& out, const ChannelChoice& choice) {
    out << choice.name;
    return choice.weight == 1 ? out : out << ':' << choice.weight;
}

template <typename T>
std::string joined(const std::vector<T>& values) {
    std::ostringstream out;
    for (std::size_t k = 0; k < values.size(); ++k) out << (k ? "," : "") << values[k];
    return out.str();
}

// Whether the finest level ends where StopParams say.
bool stops_by_itself(const BuildParams& p) {
    return p.levels.faces.empty() && p.levels.errors.empty();
}

}  // namespace

void check_params(const BuildParams& p) {
    const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
    check_channels(p.channels);
    require(p.stop.faces.value_or(2) >= 2,
            cat("faces is ", p.stop.faces.value_or(2), ", expected 2 or more"));
    require(p.stop.vertices.value_or(4) >= 4,
            cat("vertices is ", p.stop.vertices.value_or(4), ", expected 4 or more"));
    require(p.stop.error.value_or(0) >= 0 && std::isfinite(p.stop.error.value_or(0)),
            cat("error is ", p.stop.error.value_or(0), ", expected a finite number, 0 or more"));
    require(p.stop.rms.value_or(0) >= 0 && std::isfinite(p.stop.rms.value_or(0)),
            cat("rms is ", p.stop.rms.value_or(0), ", expected a finite number, 0 or more"));
    require(!p.stop.rms || (p.levels.count == 1 && p.levels.faces.empty() && p.levels.errors.empty()),
            "rms stops at one level, and more are asked for");
    require(!p.stop.rms || (map_kind(p) != MapKind::kTracked && !p.visits),
            "rms is searched over several meshes, a tracked map and visits follow the collapse to one");
    require(positive(p.stop.density) && p.stop.density <= 100,
            cat("density is ", p.stop.density, ", expected a percentage above 0, at most 100"));
    require(positive(p.geometry_weight),
            cat("geometry weight is ", p.geometry_weight, ", expected a finite number above 0"));
    require(positive(p.color_weight),
            cat("color weight is ", p.color_weight, ", expected a finite number above 0"));
    // Quadrics are single precision: products of two sums over all pixels must neither overflow nor vanish.
    const double lambda = p.geometry_weight / p.color_weight;
    require(lambda >= 1e-9 && lambda <= 1e9,
            cat("geometry weight / color weight is ", lambda, ", expected 1e-9 to 1e9"));
    const double projection = p.projection_color_weight.value_or(1);
    require(std::isfinite(projection) && projection >= 0,
            cat("projection color weight is ", projection, ", expected a finite number, 0 or more"));
    require(projection > 0 || p.map.value_or(MapKind::kTrivial) == MapKind::kTrivial,
            "projection color weight 0 is the trivial map, not a tracked or relaxed one");
    require(!p.projection_color_weight || projection == 0 ||
                p.map.value_or(MapKind::kRelaxed) != MapKind::kTrivial,
            cat("the trivial map has projection color weight 0, not ", projection));
    require(
        map_kind(p) != MapKind::kTracked || p.refine.value_or(0) == 0,
        cat("a tracked map follows the collapse alone: refine is ", p.refine.value_or(0), ", expected 0"));
    require(!p.quadric_colors || (p.refine.value_or(0) == 0 && p.objective == Objective::kLuv),
            "colors are the quadrics', but refinement and the objective rgb fit their own: expected refine 0 "
            "and objective luv");
    require(p.smoothing.value_or(0) >= 0 && p.smoothing.value_or(0) <= kMaxSmoothing,
            cat("smoothing is ", p.smoothing.value_or(0), ", expected 0 to ", kMaxSmoothing));
    require(p.levels.count >= 1 && p.levels.count <= kMaxLevels,
            cat("levels is ", p.levels.count, ", expected 1 to ", kMaxLevels));
    require(p.levels.faces.size() <= kMaxLevels && p.levels.errors.size() <= kMaxLevels,
            cat("there are more than ", kMaxLevels, " levels"));
    for (std::size_t k = 0; k < p.levels.faces.size(); ++k) {
        require(p.levels.faces[k] >= 2,
                cat("faces of level ", k, " is ", p.levels.faces[k], ", expected 2 or more"));
        require(
            k == 0 || p.levels.faces[k] < p.levels.faces[k - 1],
            cat("faces of level ", k, " is ", p.levels.faces[k], ", expected less than the level before"));
    }
    for (std::size_t k = 0; k < p.levels.errors.size(); ++k) {
        require(
            std::isfinite(p.levels.errors[k]) && p.levels.errors[k] >= 0,
            cat("error of level ", k, " is ", p.levels.errors[k], ", expected a finite number, 0 or more"));
        require(
            k == 0 || p.levels.errors[k] > p.levels.errors[k - 1],
            cat("error of level ", k, " is ", p.levels.errors[k], ", expected more than the level before"));
    }
    // The dense mesh has triangles of three pixels, and of q = 0.87.
    require(p.max_cluster.value_or(3) >= 3,
            cat("max cluster is ", p.max_cluster.value_or(3), ", expected 3 or more"));
    require(p.refine.value_or(0) >= 0 && p.refine.value_or(0) <= kMaxRefine,
            cat("refine is ", p.refine.value_or(0), ", expected 0 to ", kMaxRefine));
    require(p.exchange >= 0 && p.exchange <= 1, cat("exchange is ", p.exchange, ", expected 0 to 1"));
    require(std::isfinite(p.shape_weight) && p.shape_weight >= 0,
            cat("shape weight is ", p.shape_weight, ", expected a finite number, 0 or more"));
    require(p.min_quality >= 0 && p.min_quality <= 0.8,
            cat("min quality is ", p.min_quality, ", expected 0 to 0.8"));
}

MapKind map_kind(const BuildParams& p) {
    return p.map.value_or(p.projection_color_weight == 0.0 ? MapKind::kTrivial : MapKind::kRelaxed);
}

double map_color_weight(const BuildParams& p) {
    switch (map_kind(p)) {
        case MapKind::kTrivial:
            return 0;
        case MapKind::kTracked:
            return p.projection_color_weight.value_or(TrackParams{}.color_weight);
        case MapKind::kRelaxed:
            break;
    }
    return p.projection_color_weight.value_or(kUsualMapColorWeight);
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
    // Summing up what merges add and smoothing are not part of what others published.
    const bool published = params.metric != Metric::kFlattened;
    out.total_priority = params.total_priority.value_or(published);
    out.min_shape = static_cast<float>(params.min_quality);
    const auto vertices = static_cast<double>(std::max(finest.vertices, finest.faces / 2));
    // With an error alone the density is not known beforehand; the default's serves.
    const int passes = published ? 0 : smoothing_passes(vertices > 0 ? pixels / vertices : 100);
    out.smoothing = params.smoothing.value_or(passes);
    return out;
}

std::int64_t refine_rounds(const BuildParams& params) {
    const bool plain =
        params.metric != Metric::kFlattened || params.quadric_colors || map_kind(params) == MapKind::kTracked;
    return params.refine.value_or(plain ? 0 : kUsualRefine);
}

std::vector<BuildParameter> listed_params(const BuildParams& p, const SimplifyParams& collapse) {
    std::vector<BuildParameter> out{{"metric", std::string(metric_name(p.metric))},
                                    {"solver", std::string(solver_name(p.solver))}};
    if (!p.channels.empty()) out.emplace_back("channels", joined(p.channels));
    if (p.stop.rms) {
        out.emplace_back("rms", *p.stop.rms);
    } else if (stops_by_itself(p)) {
        if (p.stop.faces) out.emplace_back("faces", *p.stop.faces);
        if (p.stop.vertices) out.emplace_back("vertices", *p.stop.vertices);
        if (p.stop.error) out.emplace_back("error", *p.stop.error);
        if (!p.stop.faces && !p.stop.vertices && !p.stop.error) out.emplace_back("density", p.stop.density);
        if (p.levels.count > 1) out.emplace_back("levels", std::int64_t{p.levels.count});
    }
    if (!p.levels.faces.empty()) out.emplace_back("level-faces", joined(p.levels.faces));
    if (!p.levels.errors.empty()) out.emplace_back("level-errors", joined(p.levels.errors));
    if (p.metric != Metric::kHoppe) out.emplace_back("geometry-weight", p.geometry_weight);
    out.emplace_back("color-weight", p.color_weight);
    out.emplace_back("quadrics", std::string(p.rebuild_quadrics ? "rebuilt" : "accumulated"));
    out.emplace_back("priority", std::string(collapse.total_priority ? "total" : "increment"));
    constexpr const char* kMaps[] = {"relaxed", "tracked", "trivial"};
    out.emplace_back("map", std::string(kMaps[static_cast<std::size_t>(map_kind(p))]));
    out.emplace_back("projection-color-weight", map_color_weight(p));
    if (p.visits) out.emplace_back("visits", true);
    out.emplace_back("colors", std::string(p.quadric_colors ? "quadric" : "fitted"));
    out.emplace_back("smoothing", std::int64_t{collapse.smoothing});
    out.emplace_back("refine", refine_rounds(p));
    if (refine_rounds(p) > 0) {
        out.emplace_back("shape-weight", p.shape_weight);
        out.emplace_back("exchange", p.exchange);
    }
    out.emplace_back("objective", std::string(p.objective == Objective::kRgb ? "rgb" : "luv"));
    if (p.max_cluster) out.emplace_back("max-cluster", *p.max_cluster);
    if (p.min_quality > 0) out.emplace_back("min-quality", p.min_quality);
    return out;
}

}  // namespace imgmesh
