#include "formats/picture/decode/exr_layers_of.h"

#include <algorithm>
#include <cctype>

namespace imgmesh {
namespace {

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

// Returns the layer's channel of that letter; Nuke and others write the word, in any case.
std::string find_color(const ExrLayer& layer, const std::string& letter, const std::string& word) {
    if (layer.channels.contains(letter)) return letter;
    for (const auto& [name, channel] : layer.channels)
        if (lower(name) == lower(letter) || lower(name) == word) return name;
    return "";
}

bool is_number(const ExrLayer& layer, const std::string& name) {
    const auto at = layer.channels.find(name);
    return at != layer.channels.end() && at->second.type != Imf::UINT;
}

void find_colors(ExrLayer& layer) {
    layer.red = find_color(layer, "R", "red");
    layer.green = find_color(layer, "G", "green");
    layer.blue = find_color(layer, "B", "blue");
    layer.alpha = find_color(layer, "A", "alpha");
    if (is_number(layer, layer.red) && is_number(layer, layer.green) && is_number(layer, layer.blue))
        layer.color = ExrColor::kRgb;
    else if (is_number(layer, "Y") && is_number(layer, "RY") && is_number(layer, "BY"))
        layer.color = ExrColor::kLumaChroma;
    else if (is_number(layer, "Y") && !layer.channels.contains("X"))
        layer.color = ExrColor::kGrey;
}

}  // namespace

std::vector<ExrLayer> exr_layers_of(const Imf::ChannelList& channels) {
    std::map<std::string, ExrLayer> layers;
    for (auto it = channels.begin(); it != channels.end(); ++it) {
        const std::string full = it.name();
        const std::size_t dot = full.rfind('.');
        const bool named = dot != std::string::npos && dot > 0 && dot + 1 < full.size();
        const std::string name = named ? full.substr(0, dot) : "";
        ExrLayer& layer = layers[name];
        layer.name = name;
        layer.channels.emplace(named ? full.substr(dot + 1) : full, it.channel());
    }
    std::vector<ExrLayer> list;
    for (auto& [name, layer] : layers) {
        find_colors(layer);
        list.push_back(std::move(layer));
    }
    return list;
}

}  // namespace imgmesh
