#include "python/words.h"

namespace imgmesh::python {

Choices<DrawMode> draw_modes() {
    return {{"map", DrawMode::kMap},         {"gouraud", DrawMode::kGouraud}, {"wire", DrawMode::kWire},
            {"patches", DrawMode::kPatches}, {"flat", DrawMode::kFlat},       {"visits", DrawMode::kVisits}};
}

Choices<DistanceRule> distance_rules() {
    return {{"contour", DistanceRule::kContour}, {"paper", DistanceRule::kPaper}};
}

Choices<AlphaUse> alpha_uses() {
    return {{"auto", AlphaUse::kAuto},
            {"keep", AlphaUse::kKeep},
            {"cut", AlphaUse::kCut},
            {"ignore", AlphaUse::kIgnore}};
}

Choices<NonFinite> non_finite_rules() {
    return {{"refuse", NonFinite::kRefuse}, {"zero", NonFinite::kZero}, {"nearest", NonFinite::kNearest}};
}

Choices<TextureType> texture_types() {
    return {{"png", TextureType::kPng}, {"jpeg", TextureType::kJpeg}};
}

Choices<SampleType> dtype_names() {
    return {{"uint8", SampleType::kUint8},
            {"uint16", SampleType::kUint16},
            {"float16", SampleType::kHalf},
            {"float32", SampleType::kFloat}};
}

}  // namespace imgmesh::python
