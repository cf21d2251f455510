#include "libcore/pipeline/run_build.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/base/stopwatch.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/pipeline/build_stages.h"
#include "libcore/pipeline/build_to_rms.h"
#include "libcore/pipeline/param_table.h"
#include "libcore/pipeline/params.h"

namespace imgmesh {
namespace {

// Returns the channels of the mesh under their names in the file.
std::vector<std::string> used_channels(const Image& image, const BuildParams& params,
                                       const FeatureSpace& space) {
    const std::vector<ChannelChoice>& choices = params.channels;
    if (params.values) return space.auxiliary;
    if (choices.empty()) return split_names(image.channel_names).color;
    std::vector<std::string> names;
    for (const ChannelChoice& choice : choices) names.push_back(choice.name);
    return names;
}

std::int64_t largest_patch(const Level& level) {
    std::vector<std::int64_t> pixels(level.mesh.faces.size(), 0);
    for (const PixelCoord& coord : level.map)
        if (coord.face != kNone) ++pixels[coord.face];
    return *std::max_element(pixels.begin(), pixels.end());
}

// Returns the pixels on the sides of an image that stay vertices, ascending.
std::vector<Id> side_pixels(const TileSides& sides, int width, int height) {
    std::vector<Id> pixels;
    const auto add = [&](const Side& side, int first, int step) {
        for (const int at : side.vertices) pixels.push_back(as_id(first + at * step));
    };
    add(sides.top, 0, 1);
    add(sides.bottom, width * (height - 1), 1);
    add(sides.left, 0, width);
    add(sides.right, width - 1, width);
    std::ranges::sort(pixels);
    pixels.erase(std::unique(pixels.begin(), pixels.end()), pixels.end());
    return pixels;
}

// The features of pixels, and of the vertices of the dense mesh.
struct Features {
    FeatureImage apart;  // of pixels, where the dense mesh has other vertices as well; else empty
    GridMesh grid;

    Features(FeatureImage feature, const Mask& mask) {
        if (!mask.empty() || std::min(feature.width, feature.height) < 2)
            apart = {feature.width, feature.height, feature.channels, parallel_copy(feature.data)};
        grid = grid_mesh(std::move(feature), mask);
    }
    const FeatureImage& of_pixels() const { return apart.data.empty() ? grid.feature : apart; }
    FeatureImage take() { return std::move(apart.data.empty() ? grid.feature : apart); }
};

}  // namespace

Mask checked_mask(const Image& image, Mask mask) {
    if (image.width < 1 || image.height < 1) throw Error(ErrorKind::kBadArgument, "the image is empty");
    for (const float sample : image.data)
        if (!std::isfinite(sample))
            throw Error(ErrorKind::kUnsupported, "the image has samples that are not finite");
    if (mask.empty()) return mask;
    if (mask.width != image.width || mask.height != image.height)
        throw Error(ErrorKind::kBadFile, cat("the mask is ", mask.width, "x", mask.height, ", the image is ",
                                             image.width, "x", image.height));
    const std::int64_t inside = mask.count();
    if (inside == 0) throw Error(ErrorKind::kUnsupported, "no pixel is inside the mask");
    if (inside == static_cast<std::int64_t>(image.pixel_count())) return {};
    return mask;
}

BuildParams params_in(const FeatureSpace& space, BuildParams params) {
    const bool refinable =
        space.color && space.features() == 3 && space.color_weight == 1 && space.gamut == Gamut::kDisplay;
    if (!params.refine) params.refine = refinable ? refine_rounds(params) : 0;
    if ((*params.refine > 0 || params.objective == Objective::kRgb) && !refinable)
        throw Error(
            ErrorKind::kUnsupported,
            "refinement, which the presets best, max and fem include, is only for colours without HDR, "
            "and not for "
            "auxiliary channels");
    if (params.color_levels && (!space.color || space.gamut != Gamut::kDisplay))
        throw Error(ErrorKind::kUnsupported,
                    cat("color-levels is only for colours without HDR; this image has ",
                        space.color ? "HDR colours" : "no colour"));
    return params;
}

BuildParams in_features(BuildParams params, double unit) {
    if (params.stop.rms) *params.stop.rms *= unit;
    if (params.stop.error) *params.stop.error *= unit * unit;
    for (double& error : params.levels.errors) error *= unit * unit;
    return params;
}

std::int64_t meshed_pixels(const Image& image, const Mask& mask) {
    return mask.empty() ? static_cast<std::int64_t>(image.pixel_count()) : mask.count();
}
BuildResult run_build(const Image& image, Image* own, const BuildPlan& plan, const Progress& progress,
                      Mask mask) {
    const auto& [params, space, targets, first_collapse, sides, kept_features] = plan;
    Stopwatch watch;
    BuildResult result;
    result.report.clipped_samples = count_clipped(image, space, mask);
    FeatureImage feature = extract_features(image, space, mask);
    if (own) std::vector<float>().swap(own->data);
    Features features(std::move(feature), mask);
    if (sides) features.grid.side_vertices = side_pixels(*sides, image.width, image.height);
    result.report.seconds.collapse = watch.lap();
    result.report.pixels = meshed_pixels(image, mask);
    const BuildParams scaled = in_features(params, static_cast<double>(space.unit));
    SimplifyParams collapse = first_collapse;
    const std::vector<Level>& levels = result.mesh_image.levels;
    if (params.max_cluster) collapse.max_face_area = static_cast<float>(*params.max_cluster);
    const BuildStages stages{features.of_pixels(), features.grid, space, mask, scaled,
                             result.report,        progress,      sides};
    for (;;) {
        if (params.stop.rms)
            build_to_rms(stages, collapse, result.mesh_image);
        else
            build_levels(stages, collapse, targets, result.mesh_image);
        if (!params.max_cluster) break;
        // The collapse bounds a face's area. The map decides how many pixels that is.
        std::int64_t largest = 0;
        for (const Level& level : levels) largest = std::max(largest, largest_patch(level));
        if (largest <= *params.max_cluster) break;
        if (collapse.max_face_area < 0.5f)
            throw Error(ErrorKind::kUnsupported, cat("the map gathers ", largest,
                                                     " pixels in a face of the dense mesh, more than the ",
                                                     *params.max_cluster, " allowed"));
        collapse.max_face_area *=
            0.95f * static_cast<float>(*params.max_cluster) / static_cast<float>(largest);
    }
    result.mesh_image.source = {image.width,
                                image.height,
                                image.color_space,
                                image.sample_type,
                                used_channels(image, params, space),
                                !mask.empty(),
                                space.gamut};
    result.mesh_image.parameters = list_params(closed_params(params, collapse, levels.front().map.precision));
    if (kept_features) *kept_features = features.take();
    if (progress) progress(1.0, "done");
    return result;
}

}  // namespace imgmesh
