// How many vertices an error leaves, before a tile is built: what the work on them takes must be known.
#pragma once

#include "libcore/image/image.h"
#include "libcore/pipeline/build_tile.h"

namespace imgmesh {

/// Returns about how many vertices StopParams::error leaves of a tile, for each of its pixels: small parts
/// that are spread over it are collapsed, a 32nd of its pixels.
///
/// image   both sides at least 128
/// params  with stop.error
double error_density(const Image& image, const BuildParams& params, const TileCommon& common);

}  // namespace imgmesh
