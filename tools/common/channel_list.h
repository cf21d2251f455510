// --channels: which channels of an image are its features.
#pragma once

#include <vector>

#include "libcore/image/feature_space.h"
#include "tools/common/options.h"

namespace imgmesh {

/// A list of NAME or NAME:WEIGHT. What is wrong without any image (check_channels) is Error(kBadArgument)
/// at once.
CLI::Option* add_channels(CLI::App& app, std::vector<ChannelChoice>& channels);

}  // namespace imgmesh
