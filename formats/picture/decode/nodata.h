// Pixels that are no data.
#pragma once

#include <optional>

#include "libcore/image/mask.h"

namespace imgmesh {

/// Returns the pixels where not all channels but A have the value `nodata` (NaN is equal to NaN), and sets
/// the others to 0; empty() if there are none. `scale` is what the image's samples have been divided by.
Mask take_nodata_out(Image& image, double nodata, float scale = 1);

}  // namespace imgmesh
