// What the edges of a tile of the dense mesh cost: rows of edges, with SIMD where the processor has it.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/mesh/grid_mesh.h"
#include "libcore/simplify/kernel/tile_rings.h"
#include "libcore/simplify/quadrics/quadric.h"

namespace imgmesh {

/// Of each pixel of a rectangle, row by row; what leads out of it has no meaning.
struct GridCosts {
    std::vector<ShortCost> east;   ///< of the edge to the pixel on the right
    std::vector<ShortCost> south;  ///< to the pixel below
    std::vector<ShortCost> cell;   ///< of the diagonal of the cell between the two, whichever it has
};

/// Evaluates the edges inside `rect`: short_cost() of what the least error grows by, as merge_increments()
/// has it with the upper, then the left end first.
///
/// quadrics  of the pixels of the rectangle, row by row
void grid_costs(const GridMesh& grid, const PixelRect& rect, const Quadric<3>* quadrics, GridCosts& out);

}  // namespace imgmesh
