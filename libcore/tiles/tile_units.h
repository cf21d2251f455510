// Tiles of coarser levels in units of their own, as files hold them.
#pragma once

#include "libcore/mesh/mesh_image.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// Returns the mesh in units of 2^level pixels, with all positions on multiples of kPositionStep of them: the
/// grid of positions is as fine beside the distance of vertices at every level, and no coordinate of a tile
/// becomes too large for a file. Vertices on the outermost lines go to the nearest point, so that neighbours
/// that agree on a side still do; others to the nearest where no face loses its area, if there is one within
/// a quarter of a unit.
BaseMesh in_level_units(BaseMesh mesh, int level);
/// The inverse: in pixels of level 0. Exact.
BaseMesh in_pixels(BaseMesh mesh, int level);

/// Returns a tile of a coarser level as a mesh image like any other: the picture at 1 / 2^level of its size,
/// with every pixel at its own place on the mesh.
///
/// mesh    of the tile, in pixels of level 0 from its top-left pixel
/// source  of the tiles of level 0; `width`, `height` and `has_mask` are set here
/// return  one level, without error, generator and parameters. Pixels on no face are outside the mask. The
///         map lies on a grid, so it has a compact form of a thousandth of a byte a pixel
///
/// Throws Error(kInternal) if a face has no area after rounding.
MeshImage coarse_image(const BaseMesh& mesh, const SourceInfo& source, const TileGrid& grid,
                       const TileName& tile);

}  // namespace imgmesh
