// What the features of pixels and vertices stand for.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/color.h"

namespace imgmesh {

/// The features of a picture in their order: L*, u*, v* of its colour, then any other channels, each times
/// its weight.
struct FeatureSpace {
    bool color = true;                ///< the first three features are L*, u*, v*
    Gamut gamut = Gamut::kDisplay;    ///< which colours there are
    float color_weight = 1;           ///< of L*, u* and v*; > 0
    std::vector<std::string> plain;   ///< names of the channels after the colour
    std::vector<float> plain_weight;  ///< of each of them; > 0

    int features() const { return (color ? 3 : 0) + static_cast<int>(plain.size()); }
};

}  // namespace imgmesh
