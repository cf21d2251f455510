#include "libcore/pipeline/build_tile.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/index.h"
#include "libcore/image/color_levels.h"
#include "libcore/pipeline/lean_mesh.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/run_build.h"

namespace imgmesh {
namespace {

void require(bool holds, const std::string& text) {
    if (!holds) throw Error(ErrorKind::kUnsupported, text);
}

// Returns the parameters with everything chosen that an image alone would decide otherwise in each tile.
BuildParams tile_params(BuildParams params, const TileCommon& common) {
    StopParams stop;
    stop.density = common.density;
    if (!common.max_increment) stop.error = params.stop.error;
    params.stop = stop;
    if (!params.bary) params.bary = WeightPrecision::kFloat;
    if (params.mesh_precision != MeshPrecision::kCompact) return params;
    const FeatureSpace& space = common.space;
    if (!params.color_levels && space.color && space.gamut == Gamut::kDisplay)
        params.color_levels = kCompactLevels;
    // The distance of vertices is that of so many in a million pixels.
    constexpr std::int64_t kPixels = 1'000'000;
    const double vertices = std::max(1.0, common.density / 100 * kPixels);
    if (!params.position_step)
        params.position_step = compact_step(kPixels, static_cast<std::size_t>(std::llround(vertices)));
    return params;
}

// Checks a side of so many pixels. A masked line need not have all of them, nor its ends.
void check_side(const Side& side, int length, int channels, bool masked) {
    const auto& [vertices, features, shifts] = side;
    const auto ends = [&](int first, int last) { return first == 0 && last == length - 1; };
    bool sound =
        features.size() == vertices.size() * as_index(channels) &&
        std::adjacent_find(vertices.begin(), vertices.end(), std::greater_equal()) == vertices.end() &&
        (shifts.empty() || as_int(shifts.size()) == length);
    if (vertices.empty())
        sound = sound && masked;
    else
        sound = sound && vertices.front() >= 0 && vertices.back() < length &&
                (masked || ends(vertices.front(), vertices.back()));
    if (!shifts.empty()) sound = sound && shifts.front() == 0 && shifts.back() == 0;
    for (std::size_t k = 1; sound && k < shifts.size(); ++k)
        sound = 1 + shifts[k] - shifts[k - 1] > 0 && 8 * shifts[k] == std::round(8 * shifts[k]);
    if (!sound)
        throw Error(ErrorKind::kBadArgument, cat("the side of a tile is none of ", length, " pixels with ",
                                                 channels, " features whose places ascend by eighths"));
}

// Shifts along a side only shear the cells beside it: with the pixels inside at rest, none folds. Where two
// sides meet, the diagonal from one to the other has to pass the pixel inside.
void check_corners(const TileSides& sides) {
    // How far the pixel next to an end is shifted away from it.
    const auto from_first = [](const Side& s) { return s.shifts.empty() ? 0.0f : s.shifts[1]; };
    const auto from_last = [](const Side& s) {
        return s.shifts.empty() ? 0.0f : -s.shifts[s.shifts.size() - 2];
    };
    for (const auto& [s, t] : {std::pair(from_first(sides.top), from_first(sides.left)),
                               {from_last(sides.top), from_first(sides.right)},
                               {from_first(sides.bottom), from_last(sides.left)},
                               {from_last(sides.bottom), from_last(sides.right)}})
        if (!(s * t < 1))
            throw Error(ErrorKind::kBadArgument, cat("pixels beside a corner of a tile are shifted by ", s,
                                                     " and ", t, " pixels, expected a product below 1"));
}

}  // namespace

void check_tile_params(const BuildParams& params) {
    check_params(params);
    require(map_kind(params) != MapKind::kTracked,
            "a tracked map moves pixels at the sides of tiles; expected a relaxed or a trivial one");
    require(params.levels.count == 1 && params.levels.faces.empty() && params.levels.errors.empty(),
            "tiles have one level each, the set has coarser ones");
    require(!params.stop.rms, "rms is not for tiles: their number of vertices follows one threshold");
    require(!params.values, "values are not for tiles: their unit depends on the whole picture");
}

FeatureSpace tile_space(const Image& part, const BuildParams& params, Gamut gamut) {
    FeatureSpace space = feature_space(part, params.channels);
    space.gamut = gamut;
    return space;
}

FeatureImage tile_features(const Image& part, const TileCommon& common, const Mask& mask) {
    return extract_features(part, common.space, mask);
}

void round_tile_features(std::span<float> features, const BuildParams& params, const TileCommon& common) {
    const FeatureSpace& space = common.space;
    if (!space.color) return;
    const std::optional<std::int64_t> count = tile_params(params, common).color_levels;
    std::optional<ColorLevels> levels;
    if (count) levels.emplace(static_cast<int>(*count));
    // An alpha above 1 or below 0 means nothing.
    const auto found = std::ranges::find(space.auxiliary, "A");
    const auto alpha = 3 + static_cast<std::size_t>(found - space.auxiliary.begin());
    const float weight = space.color_weight;
    for (std::size_t i = 0; i + 2 < features.size(); i += as_index(space.features())) {
        const Vec3f color = Vec3f(&features[i]) / weight;
        const Vec3f rounded =
            weight * (levels ? levels->rounded(color) : quantized_color(color, space.gamut));
        std::copy(rounded.data(), rounded.data() + 3, &features[i]);
        if (found != space.auxiliary.end())
            features[i + alpha] = std::clamp(features[i + alpha], 0.0f, space.weight(as_int(alpha)));
    }
}

BuildResult build_tile(Image&& image, const BuildParams& params, const TileSides& sides,
                       const TileCommon& common, const Progress& progress, Mask mask,
                       FeatureImage* features) {
    check_tile_params(params);
    mask = checked_mask(image, std::move(mask));
    require(image.width >= 2 && image.height >= 2, "a tile is at least two pixels wide and high");
    const int channels = common.space.features();
    const bool masked = !mask.empty();
    for (const Side* side : {&sides.top, &sides.bottom}) check_side(*side, image.width, channels, masked);
    for (const Side* side : {&sides.left, &sides.right}) check_side(*side, image.height, channels, masked);
    check_corners(sides);
    image.sample_type = common.sample_type;
    BuildPlan plan;
    plan.space = common.space;
    plan.params = params_in(plan.space, tile_params(params, common));
    const BuildParams scaled = in_features(plan.params, static_cast<double>(plan.space.unit));
    const double pixels = static_cast<double>(meshed_pixels(image, mask));
    SimplifyTarget target;
    if (common.max_increment)
        target.max_increment = *common.max_increment;
    else if (scaled.stop.error)
        target.max_error = *scaled.stop.error / scaled.color_weight;
    plan.targets = {target};
    target.vertices = std::llround(pixels * common.density / 100);
    plan.collapse = collapse_params(scaled, target, pixels);
    plan.sides = &sides;
    plan.features = features;
    return run_build(image, &image, plan, progress, std::move(mask));
}

}  // namespace imgmesh
