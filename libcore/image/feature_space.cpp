#include "libcore/image/feature_space.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

std::vector<std::string> names_of(const std::vector<ChannelChoice>& choices) {
    std::vector<std::string> names;
    for (const ChannelChoice& choice : choices) names.push_back(choice.name);
    return names;
}

double weight_of(const std::vector<ChannelChoice>& choices, const std::string& name) {
    for (const ChannelChoice& choice : choices)
        if (choice.name == name) return choice.weight;
    return 1;
}

}  // namespace

SplitNames split_names(const std::vector<std::string>& names) {
    SplitNames split;
    if (has(names, "R") && has(names, "G") && has(names, "B"))
        split.color = {"R", "G", "B"};
    else if (has(names, "Y"))
        split.color = {"Y"};
    for (const std::string& name : names)
        if (!has(split.color, name.c_str())) split.auxiliary.push_back(name);
    return split;
}

std::string value_name(const std::string& name) {
    if (name == "Y") return "value";
    return name == "R" || name == "G" || name == "B" ? "value." + name : name;
}

void check_channels(const std::vector<ChannelChoice>& choices) {
    const auto refuse = [](const std::string& text) { throw Error(ErrorKind::kBadArgument, text); };
    const std::vector<std::string> names = names_of(choices);
    for (const auto& [name, weight] : choices) {
        if (!(weight > 0 && std::isfinite(weight)))
            refuse(cat("channel ", name, " has the weight ", weight, ", expected a finite number above 0"));
        if (std::ranges::count(names, name) > 1) refuse(cat("channel ", name, " is chosen twice"));
    }
    const SplitNames split = split_names(names);
    for (const std::string& name : split.color)
        if (weight_of(choices, name) != weight_of(choices, split.color[0]))
            refuse("R, G and B are one colour and have one weight");
    if (split.features() > kMaxFeatures)
        refuse(cat("the channels are ", split.features(), " features, at most ", kMaxFeatures,
                   split.color.empty() ? "" : "; a colour counts as three"));
}

FeatureSpace feature_space(const Image& image, const std::vector<ChannelChoice>& choices, const Mask& mask) {
    check_channels(choices);
    for (const ChannelChoice& choice : choices)
        if (image.channel(choice.name) < 0)
            throw Error(ErrorKind::kBadFile, cat("the image has no channel ", choice.name, ", it has ",
                                                 listed(image.channel_names)));
    const SplitNames split = split_names(choices.empty() ? image.channel_names : names_of(choices));
    FeatureSpace space;
    space.color = !split.color.empty();
    if (choices.empty() && !space.color)
        throw Error(ErrorKind::kUnsupported,
                    cat("the image has no colour, neither channels R, G, B nor Y, but ",
                        listed(image.channel_names), "; channels can be chosen"));
    if (space.color) {
        space.gamut = gamut_of(image, mask);
        space.color_weight = static_cast<float>(weight_of(choices, split.color[0]));
    }
    if (choices.empty()) return space;
    space.auxiliary = split.auxiliary;
    for (const std::string& name : space.auxiliary)
        space.auxiliary_weight.push_back(static_cast<float>(weight_of(choices, name)));
    return space;
}

std::int64_t count_clipped(const Image& image, const FeatureSpace& space, const Mask& mask) {
    if (!space.color) return 0;
    const float most = space.gamut == Gamut::kHdr ? kMaxHdr : 1;
    std::int64_t count = 0;
    for (const std::string& name : split_names(image.channel_names).color) {
        const int channel = image.channel(name);
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            const float value = image.pixel(i)[channel];
            count += mask.contains(i) && (value < 0 || value > most) ? 1 : 0;
        }
    }
    return count;
}

FeatureSpace value_space(const Image& image, std::vector<ChannelChoice> choices, const Mask& mask) {
    if (choices.empty())
        for (const std::string& name : image.channel_names)
            if (name != "A") choices.push_back({name});
    check_channels(choices);
    if (choices.empty()) throw Error(ErrorKind::kUnsupported, "the image has no values beside its alpha");
    FeatureSpace space;
    space.color = false;
    double largest = 0;
    for (const ChannelChoice& choice : choices) {
        const int channel = image.channel(choice.name);
        if (channel < 0)
            throw Error(ErrorKind::kBadFile, cat("the image has no channel ", choice.name, ", it has ",
                                                 listed(image.channel_names)));
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            if (!mask.contains(i)) continue;
            low = std::min(low, static_cast<double>(image.pixel(i)[channel]));
            high = std::max(high, static_cast<double>(image.pixel(i)[channel]));
        }
        const double range = high > low ? high - low : 0;
        largest = std::max(largest, range * choice.weight);
        // A multiple of a power of two at least as large as the range: differences to it are exact.
        const double step = range > 0 ? std::exp2(std::ceil(std::log2(range))) : 0;
        space.auxiliary.push_back(choice.name);
        space.auxiliary_offset.push_back(
            static_cast<float>(step > 0 ? std::round((low + high) / 2 / step) * step : low));
    }
    constexpr double kRange =
        100;  // of L*, for which the usual weights of geometry and of the map are chosen
    if (largest > 0) space.unit = static_cast<float>(std::exp2(std::floor(std::log2(kRange / largest))));
    for (const ChannelChoice& choice : choices)
        space.auxiliary_weight.push_back(static_cast<float>(choice.weight) * space.unit);
    return space;
}

FeatureImage extract_features(const Image& image, const FeatureSpace& space, const Mask& mask) {
    FeatureImage color;
    if (space.color) color = luv_image(image, space.gamut == Gamut::kHdr ? Range::kHdr : Range::kClipped);
    if (space.auxiliary.empty() && space.color_weight == 1) return color;
    FeatureImage out{image.width, image.height, space.features(), {}};
    out.data.reserve(out.sample_count());
    std::vector<int> from;
    for (const std::string& name : space.auxiliary) from.push_back(image.channel(name));
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (int c = 0; c < color.channels; ++c) out.data.push_back(space.color_weight * color.pixel(i)[c]);
        for (std::size_t c = 0; c < from.size(); ++c) {
            const float value = image.pixel(i)[from[c]];
            const float offset = space.offset(color.channels + as_int(c));
            const float feature = mask.contains(i) ? (value - offset) * space.auxiliary_weight[c] : 0;
            if (!(std::abs(feature) <= kLargestFeature))
                throw Error(ErrorKind::kUnsupported,
                            cat("channel ", space.auxiliary[c], " is ", value, " at pixel (", image.x_of(i),
                                ", ", image.y_of(i), "); times its weight ", space.auxiliary_weight[c],
                                " at most ", kLargestFeature, " is supported"));
            out.data.push_back(feature);
        }
    }
    return out;
}

}  // namespace imgmesh
