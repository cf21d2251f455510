// The meaning of the features of pixels and vertices.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/color.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// A pixel or vertex has at most this many features.
inline constexpr int kMaxFeatures = 16;

/// The features of an image in their order: L*, u*, v* of its colour, then auxiliary channels, each times its
/// weight.
struct FeatureSpace {
    bool color = true;                    ///< the first three features are L*, u*, v*
    Gamut gamut = Gamut::kDisplay;        ///< the colours that are possible
    float color_weight = 1;               ///< of L*, u* and v*; > 0
    std::vector<std::string> auxiliary;   ///< names of the channels after the colour
    std::vector<float> auxiliary_weight;  ///< of each auxiliary channel; > 0
    /// Of values: a feature is (value - offset) x weight, and each weight contains `unit`, a power of two
    /// that brings the largest range to 50 to 100, as that of L*. Errors in the values' own unit are features
    /// / unit.
    std::vector<float> auxiliary_offset;  ///< of each auxiliary channel; empty() for 0
    float unit = 1;

    int features() const { return (color ? 3 : 0) + as_int(auxiliary.size()); }
    float weight(int feature) const {
        if (color && feature < 3) return color_weight;
        return auxiliary_weight[as_index(feature - (color ? 3 : 0))];
    }
    float offset(int feature) const {
        return auxiliary_offset.empty() ? 0 : auxiliary_offset[as_index(feature - (color ? 3 : 0))];
    }
};

/// Splits `names` into the colour (R, G, B if all three are there, else Y, else none) and the others, in
/// order.
struct SplitNames {
    std::vector<std::string> color, auxiliary;
    int features() const { return (color.empty() ? 0 : 3) + as_int(auxiliary.size()); }
};
SplitNames split_names(const std::vector<std::string>& names);

/// Returns the name of a channel that is data and no colour: "value" for Y, "value.R" and so on for R, G and
/// B, all others as they are.
std::string value_name(const std::string& name);

/// A channel of an image as a feature.
struct ChannelChoice {
    std::string name;
    double weight = 1;  ///< of its unscaled values; compare L*u*v* with L* from 0 to 100; > 0
};

/// The usual weight of alpha: a difference of alpha counts like the difference in L* that it makes to a black
/// or a white pixel on a middle grey.
inline constexpr double kAlphaWeight = 50;

/// Throws Error(kBadArgument) for a channel that is chosen twice, a weight that is not finite and above 0,
/// different weights of R, G and B, and more than kMaxFeatures features.
void check_channels(const std::vector<ChannelChoice>& choices);

/// Returns the space of the chosen channels, or of the image's colour if none is chosen. Pixels outside
/// `mask` do not count. Throws as check_channels() does, Error(kBadFile) for a channel that the image does
/// not have, and Error(kUnsupported) for an image without colour if none is chosen.
FeatureSpace feature_space(const Image& image, const std::vector<ChannelChoice>& choices,
                           const Mask& mask = {});

/// Returns how many samples of the colour inside the mask are clipped by extract_features(): below 0, or
/// above the largest of the space's gamut.
std::int64_t count_clipped(const Image& image, const FeatureSpace& space, const Mask& mask = {});

/// Returns the space of an image of values, none of which is a colour: that of the chosen channels, or of all
/// but A if none is chosen. Offsets and the unit come from the values inside the mask. Throws as
/// feature_space() does.
FeatureSpace value_space(const Image& image, std::vector<ChannelChoice> choices, const Mask& mask = {});

/// The largest value of an auxiliary feature: the determinants of the quadrics of a whole image still fit
/// floats.
inline constexpr float kLargestFeature = 1e5f;

/// Returns the image in its `space`: L*u*v* and the values of the auxiliary channels, each less its offset,
/// times its weight.
/// Auxiliary channels are 0 outside `mask`. Linear RGB is clipped to the gamut's range. Throws
/// Error(kUnsupported) for a feature inside the mask above kLargestFeature or not finite.
FeatureImage extract_features(const Image& image, const FeatureSpace& space, const Mask& mask = {});

}  // namespace imgmesh
