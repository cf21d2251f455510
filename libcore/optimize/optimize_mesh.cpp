#include "libcore/optimize/optimize_mesh.h"

#include <cmath>
#include <vector>

#include "libcore/mesh/fixed_axes.h"
#include "libcore/optimize/grid_optimizer.h"
#include "libcore/optimize/grid_schedule.h"

namespace imgmesh {
namespace {

// Grey levels of a unit of colours in [0, 1]: RowSums rounds samples to 1/64.
constexpr float kLevels = 255;
// Heights of triangles over their longest edges. .05, as in the collapse, has .26 dB less on photographs.
constexpr double kFatness = 0.01;
// How far a vertex goes at once along its pattern, at most and at first [places].
constexpr int kLongestMove = 4 * kPlacesPerPixel, kFirstMove = kPlacesPerPixel / 2;

PlacedMesh placed(const BaseMesh& mesh, float levels, const GridSize* tile) {
    PlacedMesh out{std::vector<Spot>(mesh.vertex_count()), fixed_axes(mesh, tile), mesh.faces};
    const auto place = [](float x) { return static_cast<std::int32_t>(std::lround(x * kPlacesPerPixel)); };
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        out.spot[v].place = {place(mesh.position[v].x()), place(mesh.position[v].y())};
        for (int c = 0; c < 3; ++c) out.spot[v].color[c] = double{levels} * mesh.feature_of(v)[c];
    }
    return out;
}

BaseMesh unplaced(const PlacedMesh& mesh, float levels) {
    BaseMesh out;
    out.faces = mesh.faces;
    const auto pixels = [](std::int32_t x) { return static_cast<float>(x) / kPlacesPerPixel; };
    for (const Spot& spot : mesh.spot) {
        out.position.emplace_back(pixels(spot.place.x), pixels(spot.place.y));
        for (int c = 0; c < 3; ++c) out.feature.push_back(static_cast<float>(spot.color[c] / double{levels}));
    }
    return out;
}

RowSums sums_of(const FeatureImage& image, float levels, const Mask& mask) {
    std::vector<float> inside;
    for (std::size_t i = 0; i < image.pixel_count() && !mask.empty(); ++i)
        inside.push_back(mask.contains(i) ? 1.0f : 0.0f);
    if (levels == 1) return RowSums(image, inside);
    FeatureImage scaled = image;
    for (float& sample : scaled.data) sample *= levels;
    return RowSums(scaled, inside);
}

GridSchedule schedule_of(const RefineParams& params) {
    // Figures: docs/decisions/0048-optimised-meshes.md.
    return {.rounds = params.rounds,
            .share = params.exchange,
            .sweeps = params.anneal,
            .temperature = 0.3,
            .last_temperature = 0.03,
            .spread = 0.6 * kPlacesPerPixel * static_cast<double>(kPositionStep / params.position_step),
            .last_spread = 0.1 * kPlacesPerPixel * static_cast<double>(kPositionStep / params.position_step),
            .last_rounds = params.anneal > 0 ? 2 * params.rounds : 0,
            .last_share = 0.3 * params.exchange};
}

}  // namespace

OptimizeReport optimize_mesh(BaseMesh& mesh, const FeatureImage& image, const RefineParams& params,
                             const Progress& progress, const Mask& mask) {
    const bool unit = params.range == ColorRange::kUnit;
    const float levels = unit ? kLevels : 1;
    const RowSums sums = sums_of(image, levels, mask);
    OptimizeParams optimize;
    optimize.step = static_cast<int>(params.position_step * kPlacesPerPixel);
    optimize.longest_step = kLongestMove / optimize.step;
    optimize.first_step = std::max(1, kFirstMove / optimize.step);
    optimize.keep_faces = params.keep_faces;
    optimize.newton_steps = true;
    optimize.last_settles = 2;
    optimize.limits = {kFatness, params.min_quality, params.max_face_area,
                       unit ? ColorLimits::kUnit : ColorLimits::kLuv};
    optimize.shape_weight = params.shape_weight;
    GridOptimizer optimizer(sums, placed(mesh, levels, params.keep_sides ? &image : nullptr), optimize);
    const double unit_error = double{levels} * levels;
    OptimizeReport report{optimizer.squared_error() / unit_error, 0};
    optimizer.optimize(schedule_of(params), progress);
    report.after = optimizer.squared_error() / unit_error;
    mesh = unplaced(optimizer.result(), levels);
    return report;
}

}  // namespace imgmesh
