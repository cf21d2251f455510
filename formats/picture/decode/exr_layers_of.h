// The layers of an EXR's part, by the names of its channels. Internal to this folder.
#pragma once

#include <OpenEXR/ImfChannelList.h>

#include <map>
#include <string>
#include <vector>

namespace imgmesh {

/// What a layer's colour is made of.
enum class ExrColor { kNothing, kGrey, kLumaChroma, kRgb };

/// Channels with one prefix, that is, all before the last dot of their names.
struct ExrLayer {
    std::string name;                              ///< the prefix without its dot; empty for none
    std::map<std::string, Imf::Channel> channels;  ///< by their names without the prefix
    ExrColor color = ExrColor::kNothing;
    std::string red, green, blue, alpha;  ///< names in `channels`, empty if there is none

    std::string full(const std::string& base) const { return name.empty() ? base : name + "." + base; }
};

/// Returns the layers sorted by name, the unnamed one first. Colour is R, G and B (or red, green, blue, in
/// any case) that are no integers, else Y with the chroma channels RY and BY, else Y, unless it is beside an
/// X, which makes it a coordinate.
std::vector<ExrLayer> exr_layers_of(const Imf::ChannelList& channels);

}  // namespace imgmesh
