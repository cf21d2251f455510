// What the channels of an image are called in glTF.
#include <algorithm>

#include "formats/gltf/gltf_asset.h"
#include "libcore/base/error.h"
#include "libcore/image/feature_space.h"

namespace imgmesh {
namespace {

std::string upper_case(const std::string& name) {
    std::string out;
    for (const char c : name) {
        if (c >= 'a' && c <= 'z')
            out += static_cast<char>(c - 'a' + 'A');
        else
            out += (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
    }
    return out;
}

}  // namespace

StoredLayout layout_of(const SourceInfo& source) {
    const SplitNames names = split_names(source.channel_names);
    StoredLayout layout{!names.color.empty(), !names.color.empty() && source.gamut == Gamut::kHdr,
                        names.auxiliary.size()};
    const auto alpha = std::ranges::find(names.auxiliary, "A");
    if (layout.color && alpha != names.auxiliary.end())
        layout.alpha = static_cast<std::size_t>(alpha - names.auxiliary.begin());
    return layout;
}

std::vector<std::string> channel_attributes(const SourceInfo& source) {
    std::vector<std::string> attributes;
    for (const std::string& name : split_names(source.channel_names).auxiliary) {
        const std::string first = "_CHANNEL_" + upper_case(name);
        std::string attribute = first;
        for (int k = 2; std::ranges::count(attributes, attribute) > 0; ++k) attribute = cat(first, '_', k);
        attributes.push_back(attribute);
    }
    return attributes;
}

}  // namespace imgmesh
