// The channels beside the colour of two images against each other.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

struct ChannelDifference {
    std::string name;
    double rms = 0;  ///< root mean square over the pixels, in the channel's own unit
    double max = 0;  ///< largest difference
};

/// Of every channel that both have and that is neither colour nor alpha, in the order of `a`, over the pixels
/// that are wholly transparent in neither; none where there is no such pixel. Throws Error(kBadArgument)
/// where sizes differ.
std::vector<ChannelDifference> compare_channels(const Image& a, const Image& b);

}  // namespace imgmesh
