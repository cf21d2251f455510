// The four sides of a tile, from its pixels.
#pragma once

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/pipeline/build_tile.h"
#include "libcore/tiles/tile_mask.h"

namespace imgmesh {

/// Returns what lies on the sides of a tile. Each depends on its own line of pixels, on `params` and on
/// `common` alone, and is ready for build_tile(). On sides that a mask cuts, all pixels that the tile meshes
/// are vertices and rest.
///
/// image  of the tile, at least 2 x 2
/// mask   of the tile
TileSides sides_of_tile(const Image& image, const BuildParams& params, const TileCommon& common,
                        const TileMask& mask = {});

}  // namespace imgmesh
