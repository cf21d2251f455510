// build(): pixels in, a Mesh out. The same steps as those of imgmesh-build, so the same mesh.
#include <emscripten/bind.h>

#include "libcore/base/error.h"
#include "libcore/pipeline/build_source.h"
#include "libcore/pipeline/targets.h"
#include "web/engine/build_arguments.h"
#include "web/engine/guarded.h"
#include "web/engine/mesh_value.h"
#include "web/engine/pixels.h"

namespace imgmesh::web {
namespace {

// The program that builds containers: what a container says of its making is the same whoever called the
// libraries.
constexpr char kGenerator[] = "imgmesh-build " IMGMESH_VERSION;

AlphaParams alpha_from(const val& options) {
    AlphaParams alpha;
    if (const val use = options["alpha"]; !use.isUndefined()) {
        const auto word = use.isString() ? use.as<std::string>() : std::string();
        if (word == "auto")
            alpha.use = AlphaUse::kAuto;
        else if (word == "keep")
            alpha.use = AlphaUse::kKeep;
        else if (word == "cut")
            alpha.use = AlphaUse::kCut;
        else if (word == "ignore")
            alpha.use = AlphaUse::kIgnore;
        else
            throw Error(ErrorKind::kBadArgument, "alpha: expected one of auto, keep, cut, ignore");
    }
    if (const val threshold = options["alphaThreshold"]; !threshold.isUndefined()) {
        const double value = threshold.isNumber() ? threshold.as<double>() : 0;
        if (!(value > 0 && value <= 1))
            throw Error(ErrorKind::kBadArgument, "alphaThreshold: expected a number above 0 to 1");
        alpha.threshold = value;
    }
    return alpha;
}

// pixels      { width, height, data }
// parameters  preset, and the parameters of imgmesh-build by their names
// options     { alpha, alphaThreshold }
// progress    a function of the fraction done and the stage's name, or null
MeshPointer build(const val& pixels, const val& parameters, const val& options, const val& progress) {
    return guarded([&] {
        const Image image = image_from_pixels(pixels);
        const BuildParams params = build_params_from(parameters);
        const auto mesh = std::make_shared<MeshValue>();
        const SourcePlan plan = plan_source(image, alpha_from(options), false, params, argument_text);
        mesh->warnings = plan.warnings;
        Progress report;
        if (!progress.isNull() && !progress.isUndefined())
            report = [&](double fraction, std::string_view stage) { progress(fraction, std::string(stage)); };
        BuildResult result =
            build_mesh_image(image, plan.params, report, source_mask(image, plan, argument_text));
        for (const std::string& missed : missed_targets(plan.params, result, false))
            mesh->warnings.push_back(missed);
        result.mesh_image.generator = kGenerator;
        const std::string clipped = note_source(result, MaskOrigin::kAlpha, plan.threshold, argument_text);
        if (!clipped.empty()) mesh->warnings.push_back(clipped);
        mesh->mesh_image = std::move(result.mesh_image);
        mesh->report = std::move(result.report);
        return mesh;
    });
}

val parameters() {
    return guarded([] { return list_build_params(); });
}

}  // namespace

EMSCRIPTEN_BINDINGS(imgmesh_build) {
    emscripten::constant("version", std::string(IMGMESH_VERSION));
    emscripten::function("build", build);
    emscripten::function("buildParameters", parameters);
}

}  // namespace imgmesh::web
