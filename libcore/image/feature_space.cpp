#include "libcore/image/feature_space.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

bool has(const std::vector<std::string>& names, const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string listed(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

void check_choices(const Image& image, const std::vector<ChannelChoice>& choices) {
    for (std::size_t i = 0; i < choices.size(); ++i) {
        const auto& [name, weight] = choices[i];
        if (!(weight > 0 && std::isfinite(weight)))
            throw Error(ErrorCode::kUsage, cat("channel ", name, " has the weight ", weight,
                                               ", expected a finite number above 0"));
        for (std::size_t k = 0; k < i; ++k)
            if (choices[k].name == name)
                throw Error(ErrorCode::kUsage, cat("channel ", name, " is chosen twice"));
        if (image.channel(name) < 0)
            throw Error(ErrorCode::kBadFile,
                        cat("the picture has no channel ", name, ", it has ", listed(image.channel_names)));
    }
}

}  // namespace

SplitNames split_names(const std::vector<std::string>& names) {
    SplitNames split;
    if (has(names, "R") && has(names, "G") && has(names, "B"))
        split.color = {"R", "G", "B"};
    else if (has(names, "Y"))
        split.color = {"Y"};
    for (const std::string& name : names)
        if (!has(split.color, name.c_str())) split.plain.push_back(name);
    return split;
}

FeatureSpace feature_space(const Image& image, const std::vector<ChannelChoice>& choices, const Mask& mask) {
    check_choices(image, choices);
    std::vector<std::string> names;
    for (const ChannelChoice& choice : choices) names.push_back(choice.name);
    const SplitNames split = split_names(choices.empty() ? image.channel_names : names);
    if (choices.empty() && split.color.empty())
        throw Error(ErrorCode::kUnsupported, "the picture has no colour: neither channels R, G, B nor Y");
    FeatureSpace space;
    space.color = !split.color.empty();
    if (space.color) space.gamut = gamut_of(image, mask);
    const auto weight = [&](const std::string& name) {
        for (const ChannelChoice& choice : choices)
            if (choice.name == name) return static_cast<float>(choice.weight);
        return 1.0f;
    };
    if (space.color) space.color_weight = weight(split.color[0]);
    for (const std::string& name : split.color)
        if (weight(name) != space.color_weight)
            throw Error(ErrorCode::kUsage,
                        cat("channels R and ", name, " have the weights ", space.color_weight, " and ",
                            weight(name), "; R, G and B are one colour"));
    if (choices.empty()) return space;
    space.plain = split.plain;
    for (const std::string& name : space.plain) space.plain_weight.push_back(weight(name));
    if (space.features() > kMaxFeatures)
        throw Error(ErrorCode::kUsage, cat("the channels are ", space.features(), " features, at most ",
                                           kMaxFeatures, space.color ? "; a colour counts as three" : ""));
    return space;
}

FeatureImage extract_features(const Image& image, const FeatureSpace& space, const Mask& mask) {
    FeatureImage color;
    if (space.color) color = luv_image(image, space.gamut == Gamut::kLight ? Range::kLight : Range::kClipped);
    if (space.plain.empty() && space.color_weight == 1) return color;
    FeatureImage out{image.width, image.height, space.features(), {}};
    out.data.reserve(image.pixel_count() * static_cast<std::size_t>(out.channels));
    std::vector<int> from;
    for (const std::string& name : space.plain) from.push_back(image.channel(name));
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (int c = 0; c < color.channels; ++c) out.data.push_back(space.color_weight * color.pixel(i)[c]);
        for (std::size_t c = 0; c < from.size(); ++c) {
            const float value =
                image.data[i * static_cast<std::size_t>(image.channels) + static_cast<std::size_t>(from[c])];
            const float feature = mask.contains(i) ? value * space.plain_weight[c] : 0;
            if (!(std::abs(feature) <= kLargestFeature)) {
                const auto width = static_cast<std::size_t>(image.width);
                throw Error(ErrorCode::kUnsupported,
                            cat("channel ", space.plain[c], " is ", value, " at pixel (", i % width, ", ",
                                i / width, "); times its weight ", space.plain_weight[c], " at most ",
                                kLargestFeature, " is supported"));
            }
            out.data.push_back(feature);
        }
    }
    return out;
}

}  // namespace imgmesh
