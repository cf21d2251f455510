#include "libcore/param/fit_map.h"

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/mesh/weight_grid.h"
#include "libcore/param/color_sums.h"
#include "libcore/param/fit_colors.h"
#include "libcore/param/relax.h"
#include "libcore/param/stored_map.h"

namespace imgmesh {
namespace {

// Over-relaxation: pixels go farther than is best for each alone, as their neighbours will follow. The last
// round evens out what that leaves. With a rate, places beyond the best one would cost bits.
constexpr float kLongStride = 1.8f;

using Kept = std::vector<std::uint8_t>;

// Returns the vertices whose features stay as they are; empty() for none.
Kept kept_vertices(const BaseMesh& mesh, const FitParams& params, const GridSize& image) {
    return params.sides ? vertices_on_sides(mesh, image) : Kept();
}

void round_colors(BaseMesh& mesh, const FeatureSpace& space, const Kept& kept) {
    const float weight = space.color_weight;
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        if (!kept.empty() && kept[v]) continue;
        const Eigen::Map<Vec3f> color(mesh.feature_of(v));
        const Vec3f quantized = weight * quantized_color(color / weight, space.gamut);
        std::copy(quantized.data(), quantized.data() + 3, mesh.feature_of(v));
    }
}

float longest_edge(const BaseMesh& mesh) {
    float longest = 0;
    for (const auto& [a, b] : mesh_edges(mesh))
        longest = std::max(longest, (mesh.position[a] - mesh.position[b]).norm());
    return longest;
}

// Fits the colours to a map and to the drawing without it, and rounds them to what a container holds.
class ColorFit {
  public:
    ColorFit(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params, const PixelMap& trivial)
        : mesh_(mesh), params_(params), kept_(kept_vertices(mesh, params, feature)) {
        if (!params.keep_colors) drawing_ = color_sums(feature, trivial, mesh.faces.size());
    }

    void fit_drawing() const {
        if (!params_.keep_colors) fit_colors(mesh_, drawing_, params_.space, kPasses, nullptr, kept_);
    }
    // `sums` returns the map's ColorSums.
    template <typename Sums>
    void fit(const Sums& sums) const {
        if (params_.keep_colors) return;
        ColorSums all{drawing_.channels, {}};
        all.add(sums(), 1 - params_.gouraud_share);
        all.add(drawing_, params_.gouraud_share);
        fit_colors(mesh_, all, params_.space, kPasses, nullptr, kept_);
    }
    void round() const {
        if (params_.space.color) round_colors(mesh_, params_.space, kept_);
    }

  private:
    // Few, as each fit goes on from the one before: 6 change the RMS in the fifth digit.
    static constexpr int kPasses = 3;

    BaseMesh& mesh_;
    const FitParams& params_;
    Kept kept_;
    ColorSums drawing_;
};

}  // namespace

PixelMap fit_map(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params,
                 const Progress& progress, const Mask& mask) {
    PixelMap trivial = trivial_map(mesh, feature.width, feature.height, mask);
    const ColorFit colors(mesh, feature, params, trivial);
    const std::vector<Face> neighbors = face_neighbors(mesh);
    PixelEmbedding pixels = resting_pixels(trivial, mask);
    trivial = {};
    if (params.sides) place_sides(pixels, *params.sides, face_fields(mesh), neighbors);
    colors.fit_drawing();
    // A strip of one pixel has no cells that could fold; its map stays trivial.
    const int rounds = params.color_weight > 0 && feature.width > 1 && feature.height > 1 ? params.rounds : 0;
    RelaxParams moves{static_cast<float>(1 / params.color_weight), params.steps,
                      static_cast<float>(params.rate)};
    for (int round = 0; round < rounds; ++round) {
        if (progress) progress(double(round) / params.rounds, "map");
        const std::vector<FaceField> fields = face_fields(mesh);
        const bool first = round == 0, last = round + 1 == rounds, cheap = params.rate > 0;
        moves.sweeps = params.sweeps + (first || cheap);
        moves.stride = last || cheap ? 1 : kLongStride;
        relax(pixels, mesh, fields, neighbors, feature, moves);
        if (!last) colors.fit([&] { return color_sums(feature, pixels, fields); });
    }
    PixelMap map = stored_map(mesh, displacements(pixels, params.steps), params.bary);
    colors.fit([&] { return color_sums(feature, map, mesh.faces.size()); });
    colors.round();
    return map;
}

PixelMap fit_drawing(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params, const Mask& mask) {
    PixelMap trivial = trivial_map(mesh, feature.width, feature.height, mask);
    const Kept kept = kept_vertices(mesh, params, feature);
    if (!params.keep_colors) fit_colors(mesh, feature, {{&trivial, 1}}, params.space, nullptr, kept);
    if (params.space.color) round_colors(mesh, params.space, kept);
    return trivial;
}

PixelMap fit_given_map(BaseMesh& mesh, const FeatureImage& feature, PixelMap map, const FitParams& params,
                       const Mask& mask) {
    // Half weights place a pixel to within a step times the longest edge of its face; up to this distance
    // they are used.
    constexpr float kCoarsest = 0.125f;  // [pixels]
    const bool fine = longest_edge(mesh) * kHalfWeightStep <= kCoarsest;
    map.precision = params.bary.value_or(fine ? WeightPrecision::kHalf : WeightPrecision::kFloat);
    const double steps = weight_steps(map.precision);
    for (PixelCoord& coord : map)
        if (coord.face != kNone)
            coord = on_weight_grid(
                coord.face, {1.0 - double(coord.u) - double(coord.v), double(coord.u), double(coord.v)},
                steps);
    const PixelMap trivial = trivial_map(mesh, feature.width, feature.height, mask);
    const ColorFit colors(mesh, feature, params, trivial);
    colors.fit_drawing();
    colors.fit([&] { return color_sums(feature, map, mesh.faces.size()); });
    colors.round();
    return map;
}

}  // namespace imgmesh
