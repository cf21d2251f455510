#include "libcore/pipeline/build.h"

#include <utility>

#include "libcore/pipeline/params.h"
#include "libcore/pipeline/run_build.h"

namespace imgmesh {
namespace {

// `own` is the image itself, if its samples may be freed.
BuildResult build(const Image& image, Image* own, const BuildParams& params, const Progress& progress,
                  Mask mask) {
    check_params(params);
    mask = checked_mask(image, std::move(mask));
    BuildPlan plan;
    // Values outside the colours that a container holds would mislead the fit: L*u*v* of negative linear RGB
    // has no bound.
    plan.space = params.values ? value_space(image, params.channels, mask)
                               : feature_space(image, params.channels, mask);
    plan.params = params_in(plan.space, params);
    const BuildParams scaled = in_features(plan.params, static_cast<double>(plan.space.unit));
    const auto pixels = static_cast<double>(meshed_pixels(image, mask));
    plan.targets = collapse_targets(scaled, pixels);
    plan.collapse = collapse_params(scaled, plan.targets.front(), pixels);
    return run_build(image, own, plan, progress, std::move(mask));
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
