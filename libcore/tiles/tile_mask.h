// The pixels of a masked picture that a tile meshes. On a line that tiles share this depends on both sides.
#pragma once

#include "libcore/image/mask.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// Sides of a tile on which a pixel is outside the mask, or one beside it in this tile or in its neighbour.
struct CutSides {
    bool left = false, top = false, right = false, bottom = false;
};

struct TileMask {
    /// The pixels that the tile meshes; empty() for all. On a shared line these are the ones that have a face
    /// in a cell of the tile, and the ones that have none in any tile: each tile makes a strip of these, as
    /// in any masked image. So no pixel is lost, and no strip lies on the faces of a neighbour.
    Mask mask;
    /// Those of them that no later tile meshes, in the order of rows of tiles. Over all tiles each pixel
    /// inside the mask is counted once. Never empty().
    Mask own;
    CutSides cut;

    bool has_none() const { return !mask.empty() && mask.count() == 0; }
};

/// Returns the pixels of a tile of level 0 and one more on each side that it shares.
PixelRect reach_of(const TileGrid& grid, const TileName& tile);

/// Returns the mask of a tile of level 0.
///
/// picture  the mask on reach_of() the tile; empty() for all pixels
TileMask tile_mask(const Mask& picture, const TileGrid& grid, const TileName& tile);

}  // namespace imgmesh
