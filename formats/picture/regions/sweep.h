// Going through all of a picture whose parts are read. Internal to this room.
#pragma once

#include <functional>

#include "formats/picture/region_source.h"

namespace imgmesh {

/// See RegionSource::sweep(). Parts have at most `most` pixels, too.
void sweep_picture(const PictureFacts& facts, std::int64_t most,
                   const std::function<bool(const PixelRect&)>& look);

}  // namespace imgmesh
