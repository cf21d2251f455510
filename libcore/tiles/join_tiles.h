// A tile of a coarser level: the meshes of its children, joined and simplified.
#pragma once

#include <span>

#include "libcore/mesh/base_mesh.h"
#include "libcore/simplify/simplify_params.h"

namespace imgmesh {

/// The mesh of a tile, in its own coordinates, and where the tile lies in its parent [pixels of level 0].
struct ChildTile {
    BaseMesh mesh;
    int left = 0, top = 0;
    int width = 0, height = 0;  ///< of the tile [pixels]; the mesh spans [0, width - 1] x [0, height - 1]
};

/// Returns the children's meshes as one, in the coordinates of their parent. What a strip of a mask has
/// beyond the sides of its tile is cut off.
BaseMesh joined_children(std::span<const ChildTile> children);

/// Returns the mesh of a tile of the next level: that of its children with a quarter of their vertices. On
/// each of its sides it has half of theirs, which depends on the vertices of that side alone, so that
/// neighbours agree (coarser_side()). Where a child is missing, the vertices around the gap stay, and so do
/// those of a mask's outline. Throws Error(kInternal) where that is finer than the grid of positions.
///
/// level          of the result, at least 1: positions off the sides are multiples of kPositionStep 2^level
/// width, height  of the tile [pixels of level 0]
BaseMesh coarser_tile(std::span<const ChildTile> children, int level, int width, int height,
                      const SimplifyParams& params);

}  // namespace imgmesh
