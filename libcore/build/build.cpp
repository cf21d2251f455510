#include "libcore/build/build.h"

#include <cmath>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/collapse/collapse_edges.h"
#include "libcore/image/color.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/param/trivial_map.h"

namespace imgmesh {
namespace {

void require(bool holds, const std::string& text) {
    if (!holds) throw Error(ErrorCode::kUsage, text);
}

void check(const BuildParams& p) {
    const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
    require(p.stop.faces.value_or(2) >= 2,
            cat("faces is ", p.stop.faces.value_or(2), ", expected 2 or more"));
    require(p.stop.vertices.value_or(4) >= 4,
            cat("vertices is ", p.stop.vertices.value_or(4), ", expected 4 or more"));
    require(p.stop.error.value_or(0) >= 0 && std::isfinite(p.stop.error.value_or(0)),
            cat("error is ", p.stop.error.value_or(0), ", expected a finite number, 0 or more"));
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
    require(std::isfinite(p.projection_color_weight) && p.projection_color_weight >= 0,
            cat("projection color weight is ", p.projection_color_weight,
                ", expected a finite number, 0 or more"));
}

// Smoother gradients pay where vertices are far apart; figures in docs/paper-map.md.
int smoothing_passes(double pixels_per_vertex) {
    return pixels_per_vertex >= 250 ? 4 : pixels_per_vertex >= 66 ? 2 : pixels_per_vertex >= 12 ? 1 : 0;
}

CollapseParams collapse_params(const BuildParams& params, double pixels) {
    CollapseParams out;
    out.geometry_weight = static_cast<float>(params.geometry_weight / params.color_weight);
    const StopParams& stop = params.stop;
    out.target_faces = stop.faces.value_or(0);
    out.target_vertices = stop.vertices.value_or(0);
    if (stop.error) out.max_error = *stop.error / params.color_weight;
    if (!stop.faces && !stop.vertices && !stop.error)
        out.target_vertices = std::max(std::int64_t{4}, static_cast<std::int64_t>(std::llround(pixels * stop.density / 100)));
    const auto vertices = static_cast<double>(std::max(out.target_vertices, out.target_faces / 2));
    // With an error alone the density is not known beforehand; the default's serves.
    out.smoothing = smoothing_passes(vertices > 0 ? pixels / vertices : 100);
    return out;
}

std::vector<BuildParameter> listed(const BuildParams& p, const CollapseParams& c, const PixelMap& map) {
    std::vector<BuildParameter> out{{"metric", std::string("flattened")}};
    if (p.stop.faces) out.emplace_back("faces", *p.stop.faces);
    if (p.stop.vertices) out.emplace_back("vertices", *p.stop.vertices);
    if (p.stop.error) out.emplace_back("error", *p.stop.error);
    if (!p.stop.faces && !p.stop.vertices && !p.stop.error) out.emplace_back("density", p.stop.density);
    out.emplace_back("geometry-weight", p.geometry_weight);
    out.emplace_back("color-weight", p.color_weight);
    out.emplace_back("projection-color-weight", p.projection_color_weight);
    out.emplace_back("smoothing", std::int64_t{c.smoothing});
    out.emplace_back("bary", std::string(map.precision == WeightPrecision::kHalf ? "half" : "float"));
    return out;
}

// The colour channels that the mesh was made from, as the file had them.
std::vector<std::string> color_channels(const Image& image) {
    return image.channel("R") >= 0 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"};
}

}  // namespace

BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress) {
    check(params);
    require(image.width >= 1 && image.height >= 1, "the picture is empty");
    const auto stage = [&](double begin, double end) {
        return progress ? Progress([=](double f, std::string_view name) {
            progress(begin + f * (end - begin), name);
        })
                        : Progress();
    };
    const FeatureImage feature = luv_image(image);
    for (const float f : feature.data)
        if (!std::isfinite(f))
            throw Error(ErrorCode::kUnsupported, "the picture has samples that are not finite");

    const CollapseParams collapse = collapse_params(params, static_cast<double>(image.pixel_count()));
    CollapseResult collapsed = collapse_edges(grid_mesh(feature), collapse, stage(0.0, 0.7));

    Level level{std::move(collapsed.mesh), {}, collapsed.error * params.color_weight};
    FitParams fit;
    fit.color_weight = params.projection_color_weight;
    fit.bary = params.bary;
    level.map = fit_map(level.mesh, feature, fit, stage(0.7, 1.0));

    BuildResult result;
    result.report.collapses = collapsed.collapses;
    result.report.map_rms = map_rms(level.mesh, level.map, feature);
    result.report.gouraud_rms =
        map_rms(level.mesh, trivial_map(level.mesh, image.width, image.height), feature);
    result.mesh_image.source = {image.width,       image.height,          image.color_space,
                                image.sample_type, color_channels(image), false};
    result.mesh_image.parameters = listed(params, collapse, level.map);
    result.mesh_image.levels.push_back(std::move(level));
    if (progress) progress(1.0, "done");
    return result;
}

}  // namespace imgmesh
