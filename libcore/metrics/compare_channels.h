// Compares the auxiliary channels of two images.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// The difference of one channel.
struct ChannelDifference {
    std::string name;
    double rms = 0;  ///< root mean square over the pixels, in the channel's own unit
    double max = 0;  ///< largest difference
};

/// Compares every channel that both images have and that is neither colour nor alpha, in the order of `a`.
/// Pixels that are wholly transparent in either image are left out; if none remains, the result is empty.
/// Takes O(pixels) time. Throws Error(kBadArgument) if the sizes differ.
std::vector<ChannelDifference> compare_channels(const Image& a, const Image& b);

}  // namespace imgmesh
