// Which channels of an image are its features, as the command line has it.
#pragma once

#include <string>
#include <vector>

#include "libcore/image/feature_space.h"

namespace imgmesh {

/// The channels of a list of NAME or NAME:WEIGHT that was given to option `name`. What is wrong without any
/// image (check_channels) is Error(kBadArgument) at once.
std::vector<ChannelChoice> parse_channels(const std::string& name, const std::string& text);

}  // namespace imgmesh
