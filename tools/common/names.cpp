#include "tools/common/names.h"

#include "libcore/image/color.h"

namespace imgmesh {

Choices<ColorSpace> color_space_choices() {
    Choices<ColorSpace> choices;
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kLinear, ColorSpace::kRec709,
                                   ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3}) {
        choices.emplace_back(color_space_name(space), space);
    }
    return choices;
}

Choices<WeightPrecision> bary_choices() {
    return {{"half", WeightPrecision::kHalf}, {"float", WeightPrecision::kFloat}};
}

Choices<DracoMode> draco_choices() {
    return {{"edgebreaker", DracoMode::kEdgebreaker},
            {"sequential", DracoMode::kSequential},
            {"none", DracoMode::kOff}};
}

Choices<LayerLayout> layer_choices() {
    return {{"exr", LayerLayout::kExr}, {"compact", LayerLayout::kCompact}};
}

Choices<SampleType> sample_type_choices() {
    return {{"uint8", SampleType::kUint8},
            {"uint16", SampleType::kUint16},
            {"half", SampleType::kHalf},
            {"float", SampleType::kFloat}};
}

Choices<DrawMode> draw_mode_choices() {
    return {{"map", DrawMode::kMap},         {"gouraud", DrawMode::kGouraud}, {"wire", DrawMode::kWire},
            {"patches", DrawMode::kPatches}, {"flat", DrawMode::kFlat},       {"visits", DrawMode::kVisits}};
}

Choices<DistanceRule> distance_choices() {
    return {{"contour", DistanceRule::kContour}, {"paper", DistanceRule::kPaper}};
}

Choices<SegmentQuality> segment_quality_choices() {
    return {{"fast", SegmentQuality::kFast}, {"default", SegmentQuality::kDefault}};
}

Choices<AlphaUse> alpha_choices() {
    return {{"auto", AlphaUse::kAuto},
            {"keep", AlphaUse::kKeep},
            {"cut", AlphaUse::kCut},
            {"ignore", AlphaUse::kIgnore}};
}

Choices<NonFinite> non_finite_choices() {
    return {{"refuse", NonFinite::kRefuse}, {"zero", NonFinite::kZero}, {"nearest", NonFinite::kNearest}};
}

Choices<TextureType> texture_type_choices() {
    return {{"png", TextureType::kPng}, {"jpeg", TextureType::kJpeg}};
}

Choices<Tune> tune_choices() {
    return {{"psnr", Tune::kPsnr}, {"luma", Tune::kLuma}, {"ssim", Tune::kSsim}};
}

}  // namespace imgmesh
