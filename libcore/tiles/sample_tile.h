// A tile of a coarser level from samples of its children's meshes: for masks that are finer than its pixels.
#pragma once

#include <span>

#include "libcore/tiles/join_tiles.h"

namespace imgmesh {

/// Returns the mesh of a tile of the next level as coarser_tile() does, but from its picture: the children's
/// meshes are drawn at the pixels of the level, and collapsed as a masked image to about a quarter of their
/// vertices. What lies between these pixels is left out, so there are at most two faces for each of them. All
/// pixels on the tile's sides stay vertices. Without faces if nothing is at any pixel.
BaseMesh sampled_tile(std::span<const ChildTile> children, int level, int width, int height,
                      const SimplifyParams& params);

}  // namespace imgmesh
