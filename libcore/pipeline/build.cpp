#include "libcore/pipeline/build.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "libcore/base/error.h"
#include "libcore/base/parallel_vector.h"
#include "libcore/base/stopwatch.h"
#include "libcore/image/color.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/round_positions.h"
#include "libcore/mesh/trivial_map.h"
#include "libcore/metrics/metrics.h"
#include "libcore/param/fit_map.h"
#include "libcore/pipeline/lean_mesh.h"
#include "libcore/pipeline/lod_meshes.h"
#include "libcore/pipeline/param_table.h"
#include "libcore/pipeline/params.h"
#include "libcore/pipeline/refine_level.h"
#include "libcore/pipeline/rms_search.h"
#include "libcore/pipeline/tracking.h"
#include "libcore/simplify/simplify.h"

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

// Turns features into what a reader gets: colours without their weight and on the colours' grid, other
// channels in their own unit.
void take_weights_out(BaseMesh& mesh, const FeatureSpace& space) {
    for (Id v = 0; v < mesh.vertex_count(); ++v) {
        float* f = mesh.feature_of(v);
        for (int c = 0; c < space.features(); ++c) f[c] = f[c] / space.weight(c) + space.offset(c);
        if (!space.color || space.color_weight == 1) continue;
        const Vec3f color = quantized_color(Vec3f(f), space.gamut);
        std::copy(color.data(), color.data() + 3, f);
    }
}

// Least squares overshoots beside edges. An alpha above 1 or below 0 means nothing, so the vertices' stays
// between the least and the largest of the image.
void limit_alpha(BaseMesh& mesh, const FeatureImage& feature, const FeatureSpace& space, const Mask& mask) {
    const auto at = std::ranges::find(space.auxiliary, "A");
    if (at == space.auxiliary.end()) return;
    const auto c = (space.color ? 3 : 0) + (at - space.auxiliary.begin());
    float least = std::numeric_limits<float>::max(), most = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < feature.pixel_count(); ++i) {
        if (!mask.contains(i)) continue;
        least = std::min(least, feature.pixel(i)[c]);
        most = std::max(most, feature.pixel(i)[c]);
    }
    for (Id v = 0; v < mesh.vertex_count(); ++v)
        mesh.feature_of(v)[c] = std::clamp(mesh.feature_of(v)[c], least, most);
}

// Returns the parameters with errors in features instead of values' own unit.
BuildParams in_features(BuildParams params, double unit) {
    if (params.stop.rms) *params.stop.rms *= unit;
    if (params.stop.error) *params.stop.error *= unit * unit;
    for (double& error : params.levels.errors) error *= unit * unit;
    return params;
}

// Maps the progress of a part to [begin, end] of the whole.
Progress part_of(const Progress& whole, double begin, double end) {
    if (!whole) return {};
    return [=](double f, std::string_view stage) { whole(begin + f * (end - begin), stage); };
}

std::int64_t largest_patch(const Level& level) {
    std::vector<std::int64_t> pixels(level.mesh.faces.size(), 0);
    for (const PixelCoord& coord : level.map)
        if (coord.face != kNone) ++pixels[coord.face];
    return *std::max_element(pixels.begin(), pixels.end());
}

// Checks the mask. Returns an empty one if all pixels are inside.
Mask checked(Mask mask, const Image& image) {
    if (mask.empty()) return mask;
    if (mask.width != image.width || mask.height != image.height)
        throw Error(ErrorKind::kBadFile, cat("the mask is ", mask.width, "x", mask.height, ", the image is ",
                                             image.width, "x", image.height));
    const std::int64_t inside = mask.count();
    if (inside == 0) throw Error(ErrorKind::kUnsupported, "no pixel is inside the mask");
    if (inside == static_cast<std::int64_t>(image.pixel_count())) return {};
    return mask;
}

// Turns collapsed meshes into levels.
struct Pipeline {
    const FeatureImage& feature;
    const GridMesh& grid;
    const FeatureSpace& space;
    const Mask& mask;
    const BuildParams& params;
    BuildReport& report;
    const Progress& progress;

    std::vector<SimplifyResult> collapse(const SimplifyParams& limits,
                                         std::span<const SimplifyTarget> targets,
                                         const SimplifyHooks& hooks = {}) const {
        Stopwatch watch;
        std::vector<SimplifyResult> collapsed =
            simplify(grid, limits, targets, part_of(progress, 0, 0.7), hooks);
        report.seconds.collapse += watch.lap();
        return collapsed;
    }

    // Refines, makes the pixel map (unless `tracked` has one) and fits colours. Takes the share [begin, end]
    // of the progress.
    Level finish(SimplifyResult&& collapsed, const SimplifyParams& limits, std::optional<PixelMap> tracked,
                 LevelReport& figures, double begin, double end) const {
        Stopwatch watch;
        RefineParams refinement = refine_params(params);
        refinement.max_face_area = limits.max_face_area;
        const double unit = static_cast<double>(space.unit);
        Level level{std::move(collapsed.mesh), {}, collapsed.error * params.color_weight / (unit * unit)};
        const double middle = refinement.rounds > 0 ? begin + 0.7 * (end - begin) : begin;
        if (refinement.rounds > 0 || params.objective == Objective::kRgb)
            refine_level(level.mesh, feature, mask, params.objective, refinement,
                         part_of(progress, begin, middle));
        figures.position_step = position_step(params, report.pixels, level.mesh.vertex_count());
        if (figures.position_step > double{kPositionStep}) {
            refinement.position_step = static_cast<float>(figures.position_step);
            figures.fine_vertices = round_positions(level.mesh, refinement.position_step, params.min_quality);
            if (refinement.rounds > 0) {
                // One round on the grid makes good what the rounding has cost.
                refinement.rounds = 1;
                refinement.relocations = 0;
                refinement.anneal = 0;
                refine_level(level.mesh, feature, mask, params.objective, refinement, {});
            }
        }
        report.seconds.refine += watch.lap();
        const FitParams fit = fit_params(params, space);
        const bool left_out = params.map_is_left_out && !tracked;
        if (left_out)
            level.map = fit_drawing(level.mesh, feature, fit, mask);
        else
            level.map = tracked ? fit_given_map(level.mesh, feature, *std::move(tracked), fit, mask)
                                : fit_map(level.mesh, feature, fit, part_of(progress, middle, end), mask);
        const PixelMap trivial =
            left_out ? PixelMap() : trivial_map(level.mesh, feature.width, feature.height, mask);
        const PixelMap& drawing = left_out ? level.map : trivial;
        figures.color_levels = round_colors(params, level.mesh, feature, space, level.map, drawing,
                                            fit.gouraud_share, fit.keep_colors);
        limit_alpha(level.mesh, feature, space, mask);
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

    // Estimates the error of the map of an unrefined mesh after one round.
    double estimated_rms(SimplifyResult&& collapsed) const {
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
};

// Collapses and makes maps with the present limits of the collapse.
void build_levels(const Pipeline& pipeline, const SimplifyParams& limits,
                  std::span<const SimplifyTarget> targets, MeshImage& mesh_image) {
    Stopwatch watch;
    Tracking tracking(pipeline.grid, pipeline.feature.width, pipeline.feature.height, pipeline.params);
    BuildReport& report = pipeline.report;
    report.seconds.collapse += watch.lap();
    std::vector<SimplifyResult> collapsed = pipeline.collapse(limits, targets, tracking.hooks());
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
        mesh_image.levels.push_back(pipeline.finish(std::move(collapsed[k]), limits, std::move(tracked),
                                                    figures, begin, begin + share));
        figures.target = k;
    }
}

// Final error / error of an estimate: a mesh without refinement whose pixels have moved for one round. 0.75
// to 0.9 on photographs with the usual refinement. A wrong value costs at worst one more finished mesh.
constexpr double kEstimateShare = 0.85;

// Meshes for the search by a wanted error.
class RmsMeshes : public MeasuredMeshes {
  public:
    RmsMeshes(const Pipeline& pipeline, SimplifyParams& limits, MeshImage& mesh_image)
        : pipeline_(pipeline),
          limits_(limits),
          collapsing_(part_of(pipeline.progress, 0, 0.7)),
          lods_(
              pipeline.grid, [this](std::int64_t vertices) { return limits_for(vertices); }, collapsing_),
          mesh_image_(mesh_image) {}

    Probe finished(std::int64_t vertices) override {
        SimplifyResult collapsed = collapse(vertices, true);
        collapses_ = collapsed.collapses;
        level_ = pipeline_.finish(std::move(collapsed), limits_, {}, figures_, 0.7, 1);
        // The search is in features.
        return {static_cast<std::int64_t>(level_.mesh.vertex_count()),
                figures_.map_rms * static_cast<double>(pipeline_.space.unit)};
    }
    void keep() override {
        mesh_image_.levels.clear();
        mesh_image_.levels.push_back(std::move(level_));
        pipeline_.report.levels = {figures_};
        pipeline_.report.collapses = collapses_;
        limits_.smoothing = smoothing_;
    }
    Probe estimated(std::int64_t vertices) override {
        SimplifyResult collapsed = collapse(vertices, false);
        const auto count = static_cast<std::int64_t>(collapsed.mesh.vertex_count());
        return {count, kEstimateShare * pipeline_.estimated_rms(std::move(collapsed))};
    }

  private:
    SimplifyResult collapse(std::int64_t vertices, bool lods) {
        Stopwatch watch;
        SimplifyResult collapsed = lods_.mesh(vertices, lods);
        pipeline_.report.seconds.collapse += watch.lap();
        return collapsed;
    }
    SimplifyParams limits_for(std::int64_t vertices) {
        SimplifyParams limits = limits_;
        limits.smoothing = smoothing_ = collapse_params(pipeline_.params, {.vertices = vertices},
                                                        static_cast<double>(pipeline_.report.pixels))
                                            .smoothing;
        return limits;
    }

    const Pipeline& pipeline_;
    SimplifyParams& limits_;
    int smoothing_ = 0;  // of the present run
    Progress collapsing_;
    LodMeshes lods_;
    MeshImage& mesh_image_;
    Level level_;
    LevelReport figures_;
    std::int64_t collapses_ = 0;
};

// Returns the level that StopParams::rms asks for. Sets limits.smoothing to that of its collapse.
void build_to_rms(const Pipeline& pipeline, SimplifyParams& limits, MeshImage& mesh_image) {
    const GridMesh& grid = pipeline.grid;
    const double rms = *pipeline.params.stop.rms;
    mesh_image.levels.clear();
    // All vertices of the dense mesh: strips of one pixel have more vertices than pixels.
    const auto vertices = grid.mask.empty()
                              ? static_cast<std::int64_t>(grid.vertex_count())
                              : pipeline.report.pixels + static_cast<std::int64_t>(grid.copies.size());
    // Photographs reach an RMS of 3.8 with 1 % of their pixels. The search starts with more than most
    // need.
    constexpr double kUsualRms = 3.8, kUsualShare = 0.01, kAhead = 5, kPower = 2.6, kMost = 1.0 / 8;
    const double share = kAhead * kUsualShare * std::pow(kUsualRms / std::max(rms, 1e-3), kPower);
    const double guess = std::clamp(share, 1.0 / 4096, kMost) * static_cast<double>(vertices);
    RmsMeshes meshes(pipeline, limits, mesh_image);
    // Without success, the search ends with the mesh of all vertices.
    if (!search_rms(std::max(std::int64_t{4}, vertices), std::llround(guess), rms, meshes)) meshes.keep();
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
};

// `own` is the image itself, if its samples may be freed.
BuildResult build(const Image& image, Image* own, const BuildParams& asked, const Progress& progress,
                  Mask mask) {
    check_params(asked);
    if (image.width < 1 || image.height < 1) throw Error(ErrorKind::kBadArgument, "the image is empty");
    for (const float sample : image.data)
        if (!std::isfinite(sample))
            throw Error(ErrorKind::kUnsupported, "the image has samples that are not finite");
    mask = checked(std::move(mask), image);
    Stopwatch watch;
    // Values outside the colours that a container holds would mislead the fit: L*u*v* of negative linear RGB
    // has no bound.
    const FeatureSpace space =
        asked.values ? value_space(image, asked.channels, mask) : feature_space(image, asked.channels, mask);
    const bool refinable =
        space.color && space.features() == 3 && space.color_weight == 1 && space.gamut == Gamut::kDisplay;
    BuildParams params = asked;
    if (!params.refine) params.refine = refinable ? refine_rounds(asked) : 0;
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
    BuildResult result;
    result.report.clipped_samples = count_clipped(image, space, mask);
    FeatureImage feature = extract_features(image, space, mask);
    if (own) std::vector<float>().swap(own->data);
    const Features features(std::move(feature), mask);
    result.report.seconds.collapse = watch.lap();
    result.report.pixels = mask.empty() ? static_cast<std::int64_t>(image.pixel_count()) : mask.count();
    const auto pixels = static_cast<double>(result.report.pixels);
    const BuildParams scaled = in_features(params, static_cast<double>(space.unit));
    const std::vector<SimplifyTarget> targets = collapse_targets(scaled, pixels);
    SimplifyParams collapse = collapse_params(scaled, targets.front(), pixels);
    const std::vector<Level>& levels = result.mesh_image.levels;
    if (params.max_cluster) collapse.max_face_area = static_cast<float>(*params.max_cluster);
    const Pipeline pipeline{features.of_pixels(), features.grid, space, mask, scaled,
                            result.report,        progress};
    for (;;) {
        if (params.stop.rms)
            build_to_rms(pipeline, collapse, result.mesh_image);
        else
            build_levels(pipeline, collapse, targets, result.mesh_image);
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
    if (progress) progress(1.0, "done");
    return result;
}

}  // namespace

BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress,
                             Mask mask) {
    return build(image, nullptr, params, progress, std::move(mask));
}

BuildResult build_mesh_image(Image&& image, const BuildParams& params, const Progress& progress, Mask mask) {
    return build(image, &image, params, progress, std::move(mask));
}

}  // namespace imgmesh
