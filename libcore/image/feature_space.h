// What the features of pixels and vertices stand for.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/channel_count.h"
#include "libcore/image/color.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// The features of an image in their order: L*, u*, v* of its colour, then any other channels, each times
/// its weight.
struct FeatureSpace {
    bool color = true;                   ///< the first three features are L*, u*, v*
    Gamut gamut = Gamut::kDisplay;       ///< which colours there are
    float color_weight = 1;              ///< of L*, u* and v*; > 0
    std::vector<std::string> auxiliary;  ///< names of the channels after the colour
    std::vector<float> plain_weight;     ///< of each of them; > 0

    int features() const { return (color ? 3 : 0) + static_cast<int>(auxiliary.size()); }
    float weight(int feature) const {
        if (color && feature < 3) return color_weight;
        return plain_weight[static_cast<std::size_t>(feature - (color ? 3 : 0))];
    }
};

/// Which of `names` are the colour (R, G, B where all three are there, else Y, else none), and the others, in
/// order.
struct SplitNames {
    std::vector<std::string> color, auxiliary;
    int features() const { return (color.empty() ? 0 : 3) + static_cast<int>(auxiliary.size()); }
};
SplitNames split_names(const std::vector<std::string>& names);

/// A channel of an image as a feature.
struct ChannelChoice {
    std::string name;
    double weight = 1;  ///< of its values as they are, beside L*u*v* with L* from 0 to 100; > 0
};

/// Throws Error(kBadArgument) for a channel that is chosen twice, a weight that is not finite and above 0,
/// different weights of R, G and B and more than kMaxFeatures features.
void check_channels(const std::vector<ChannelChoice>& choices);

/// The space of the chosen channels, of the image's colour for none. What is outside `mask` does not count.
/// Throws as check_channels() does, Error(kBadFile) for a channel that the image does not have,
/// kUnsupported for an image without colour where none is chosen.
FeatureSpace feature_space(const Image& image, const std::vector<ChannelChoice>& choices,
                           const Mask& mask = {});

/// The largest value of a auxiliary feature: the determinants of quadrics of a whole image have room then
/// in floats.
inline constexpr float kLargestFeature = 1e5f;

/// The image in `space`, which is of that image: L*u*v* and the values of the auxiliary channels, each
/// times its weight; the latter 0 outside `mask`. Light is clipped to the gamut's range. Throws
/// Error(kUnsupported) for a feature inside above kLargestFeature or not finite.
FeatureImage extract_features(const Image& image, const FeatureSpace& space, const Mask& mask = {});

}  // namespace imgmesh
