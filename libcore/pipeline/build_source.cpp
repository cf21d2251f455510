#include "libcore/pipeline/build_source.h"

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/image/mask_value.h"

namespace imgmesh {
namespace {

// The threshold of masks: half, as everywhere.
constexpr double kOpaqueEnough = 0.5;

bool is_chosen(const std::vector<ChannelChoice>& channels, const char* name) {
    return std::ranges::find(channels, name, &ChannelChoice::name) != channels.end();
}

// What becomes of an image's alpha; never kAuto.
AlphaUse alpha_use(const Image& image, AlphaUse asked, bool has_mask, const BuildParams& params) {
    if (image.channel("A") < 0) return AlphaUse::kIgnore;
    // Values have a mask beside them, unless alpha is chosen as one of them.
    if (params.values && asked == AlphaUse::kAuto) return has_mask ? AlphaUse::kIgnore : AlphaUse::kCut;
    if (asked == AlphaUse::kKeep) return AlphaUse::kKeep;
    if (asked == AlphaUse::kIgnore || has_mask) return AlphaUse::kIgnore;
    const bool left_out = !params.channels.empty() && !is_chosen(params.channels, "A");
    if (asked == AlphaUse::kCut || left_out) return AlphaUse::kCut;
    return has_soft_alpha(image) ? AlphaUse::kKeep : AlphaUse::kCut;
}

// Adds alpha to the channels of the mesh. Refinement is for colour alone: where nobody has asked for the
// alpha, it is left out with a warning instead of an error.
void keep_alpha(const Image& image, bool asked, SourcePlan& plan, const ParamText& text) {
    BuildParams& p = plan.params;
    if (p.channels.empty())
        for (const std::string& name : split_names(image.channel_names).color)
            p.channels.push_back({name, 1});
    if (!is_chosen(p.channels, "A")) p.channels.push_back({"A", kAlphaWeight});
    if (asked || (p.refine.value_or(0) == 0 && p.objective == Objective::kLuv)) return;
    p.refine = 0;
    p.objective = Objective::kLuv;
    plan.warnings.push_back(
        cat("its soft alpha is kept, and so the mesh is not refined; ", text("alpha", "cut"), " refines it"));
}

// Returns the least alpha, or brightness of a mask, of the pixels that are meshed.
double mask_threshold(const Image& image, bool has_mask, SourcePlan& plan, const ParamText& text) {
    if (plan.alpha != AlphaUse::kKeep || has_mask) return kOpaqueEnough;
    const float least = least_visible_alpha(image);
    if (least > kVisibleAlpha)
        plan.warnings.push_back(cat("its specks with an alpha below 8/255 are left out; ",
                                    text("alpha-threshold", "0.002"), " keeps them"));
    return least;
}

// The code of an integer sample, of its largest. Samples of 32 bits may be smaller than any code.
std::string code_text(float value, SampleType type) {
    const int most = type == SampleType::kUint8 ? 255 : type == SampleType::kUint16 ? 65535 : 0;
    const auto code = static_cast<long>(value * static_cast<float>(most) + 0.5f);
    if (most == 0) return cat(value);
    return code == 0 && value > 0 ? cat(value, " of 1") : cat(code, " of ", most);
}

// A number of two digits.
std::string rough_text(float value) {
    std::ostringstream out;
    out.precision(2);
    out << value;
    return out.str();
}

}  // namespace

std::optional<std::vector<std::string>> channels_to_read(const BuildParams& params, bool texture) {
    if (texture && !params.channels.empty()) return std::nullopt;
    if (params.values && params.channels.empty()) return std::nullopt;  // all are meshed
    std::vector<std::string> names;
    for (const ChannelChoice& choice : params.channels) names.push_back(choice.name);
    return names;
}

SourcePlan plan_source(const Image& image, const AlphaParams& alpha, bool has_mask, const BuildParams& params,
                       const ParamText& text) {
    SourcePlan plan;
    plan.alpha = alpha_use(image, alpha.use, has_mask, params);
    plan.params = params;
    if (params.values)
        for (ChannelChoice& channel : plan.params.channels) channel.name = value_name(channel.name);
    if (plan.alpha == AlphaUse::kKeep) keep_alpha(image, alpha.use == AlphaUse::kKeep, plan, text);
    plan.threshold = alpha.threshold ? *alpha.threshold : mask_threshold(image, has_mask, plan, text);
    return plan;
}

Mask source_mask(const Image& image, const SourcePlan& plan, const ParamText& text) {
    if (plan.alpha == AlphaUse::kIgnore) return {};
    const auto least = static_cast<float>(plan.threshold);
    Mask mask = alpha_mask(image, least);
    if (!mask.empty() && mask.count() == 0)
        throw Error(ErrorKind::kUnsupported,
                    cat("no pixel is inside the mask: alpha is below ", least, " everywhere; ",
                        text("alpha", "ignore"), " meshes the colours without it"));
    return mask;
}

Mask picture_mask(const Image& picture, const Image& image, const std::string& name, double threshold,
                  const ParamText& text) {
    if (picture.width != image.width || picture.height != image.height)
        throw Error(ErrorKind::kBadFile, cat("the mask is ", picture.width, "x", picture.height, ", ", name,
                                             " is ", image.width, "x", image.height));
    const auto least = static_cast<float>(threshold);
    Mask mask = image_mask(picture, least);
    if (mask.count() > 0) return mask;
    const float largest = largest_mask_value(picture, least);
    const std::string found =
        cat("no pixel is inside the mask: its largest value is ", code_text(largest, picture.sample_type));
    if (largest <= 0) throw Error(ErrorKind::kUnsupported, cat(found, ", and pixels inside are above 0"));
    // Half of the largest value is between the two values of a mask that has only two.
    throw Error(ErrorKind::kUnsupported,
                cat(found, ", below the threshold of ", least, "; ",
                    text("alpha-threshold", rough_text(largest / 2)), " takes the mask"));
}

std::string note_source(BuildResult& result, MaskOrigin origin, double threshold, const ParamText& text) {
    if (result.mesh_image.source.has_mask) {
        const char* const names[] = {"alpha", "picture", "nodata"};
        std::vector<BuildParameter>& parameters = result.mesh_image.parameters;
        parameters.emplace_back("mask", std::string(names[static_cast<std::size_t>(origin)]));
        if (origin != MaskOrigin::kNoData) parameters.emplace_back("alpha-threshold", threshold);
    }
    if (result.report.clipped_samples == 0) return {};
    return cat(result.report.clipped_samples,
               " samples of its colours are below 0 or too large and were clipped; ", text("values", ""),
               " keeps numbers as they are");
}

}  // namespace imgmesh
