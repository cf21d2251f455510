#include "libcore/pipeline/lean_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "libcore/image/color_levels.h"
#include "libcore/mesh/round_positions.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_colors.h"

namespace imgmesh {
namespace {

// Returns the colour's root mean square error through the map [L*u*v*].
double color_rms(const BaseMesh& mesh, const PixelMap& map, const FeatureImage& feature,
                 const FeatureSpace& space) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const double rms = feature_rms(mesh, map, feature, c);
        sum += rms * rms;
    }
    return std::sqrt(sum) / double{space.color_weight};
}

// Returns the fewest levels with which rounding adds at most kAdded to the squared error of R, G and B, or 0
// if that takes too many. Levels 1 / (n - 1) apart have the squared error 1 / 12 (n - 1)^2, of which pixels,
// each a mean of three vertices, get about half.
int compact_levels(double rms) {
    constexpr double kAdded = 0.0125;  // 0.05 dB
    // RMS in L*u*v* / RMS of R, G and B from 0 to 1: 111 to 135 for the meshes of 12 photographs.
    constexpr double kLuvOfRgb = 120;
    // Fewer are seen where an image is smooth, however large its error is elsewhere.
    constexpr double kFewest = 64;
    const double count = 1 + std::ceil(kLuvOfRgb / (rms * std::sqrt(24 * kAdded)));
    return count > kMostColorLevels ? 0 : static_cast<int>(std::max(count, kFewest));
}

// Rounds all colours but the `kept` ones; empty() for none.
void round_to(const ColorLevels& levels, float weight, BaseMesh& mesh,
              std::span<const std::uint8_t> kept = {}) {
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        if (!kept.empty() && kept[v]) continue;
        const Vec3f color = weight * levels.rounded(Vec3f(mesh.feature_of(v)) / weight);
        std::copy(color.data(), color.data() + 3, mesh.feature_of(v));
    }
}

}  // namespace

double compact_step(std::int64_t pixels, std::size_t vertices) {
    constexpr double kMost = 0.5, kShare = 1.0 / 16;
    const double distance = std::sqrt(static_cast<double>(pixels) / static_cast<double>(vertices));
    const double step = std::exp2(std::floor(std::log2(kShare * distance)));
    return std::clamp(step, double{kPositionStep}, kMost);
}

double position_step(const BuildParams& params, std::int64_t pixels, std::size_t vertices) {
    if (params.position_step) return *params.position_step;
    return params.mesh_precision == MeshPrecision::kCompact ? compact_step(pixels, vertices)
                                                            : double{kPositionStep};
}

int round_colors(const BuildParams& params, BaseMesh& mesh, const FeatureImage& feature,
                 const FeatureSpace& space, const PixelMap& map, const PixelMap& trivial,
                 const FitParams& fit) {
    if (!space.color || space.gamut != Gamut::kDisplay) return 0;
    int count = 0;
    if (params.color_levels)
        count = static_cast<int>(*params.color_levels);
    else if (params.mesh_precision == MeshPrecision::kCompact)
        count = compact_levels(color_rms(mesh, map, feature, space));
    if (count == 0) return 0;
    const ColorLevels levels(count);
    std::vector<std::uint8_t> kept;
    if (fit.sides) kept = vertices_on_sides(mesh, feature);
    if (!fit.keep_colors) {
        std::vector<FitTerm> terms = {{&map, 1}};
        if (&map != &trivial) terms = {{&map, 1 - fit.gouraud_share}, {&trivial, fit.gouraud_share}};
        fit_colors(mesh, feature, terms, space, &levels, kept);
        return count;
    }
    round_to(levels, space.color_weight, mesh, kept);
    return count;
}

bool forget_position_steps(BuildReport& report) {
    bool any = false;
    for (LevelReport& level : report.levels) {
        any |= level.position_step > double{kPositionStep};
        level.position_step = double{kPositionStep};
        level.fine_vertices = 0;
    }
    return any;
}

void make_compact(MeshImage& mesh_image, bool keep_positions) {
    const ColorLevels levels(kCompactLevels);
    const SourceInfo& source = mesh_image.source;
    const bool color = !split_names(source.channel_names).color.empty() && source.gamut == Gamut::kDisplay;
    for (Level& level : mesh_image.levels) {
        if (color) round_to(levels, 1, level.mesh);
        const auto pixels = std::ranges::count_if(
            level.map.values, [](const PixelCoord& coord) { return coord.face != kNone; });
        if (!keep_positions)
            round_positions(level.mesh, static_cast<float>(compact_step(pixels, level.mesh.vertex_count())));
    }
}

}  // namespace imgmesh
