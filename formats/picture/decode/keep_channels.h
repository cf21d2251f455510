// Leaves channels of an image out. Internal to this folder.
#pragma once

#include <vector>

#include "libcore/image/image.h"

namespace imgmesh {

/// Keeps the channels c of which keep[c] is not 0.
void keep_channels(Image& image, const std::vector<char>& keep);

}  // namespace imgmesh
