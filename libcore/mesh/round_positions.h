// Vertex positions on a coarser grid, which take fewer bytes in a file.
#pragma once

#include <cstddef>

#include "libcore/base/grid.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Moves vertices to multiples of `step`, each to the nearest one where all its faces keep a positive area
/// and at least a quarter of what they have. Vertices on the sides of the mesh's box slide along them, all
/// others on a boundary stay, so the mesh covers what it has covered.
///
/// step         a power of two, kPositionStep or more [pixels]
/// min_quality  no face becomes worse than this (q = 4 sqrt(3) area / sum of squared edges), unless it was
/// return       the number of vertices that are no multiples of `step` all the same
/// tile         the image of a tile, whose vertices on the image's sides stay; null if it is none
///
/// Takes O(faces) time.
std::size_t round_positions(BaseMesh& mesh, float step, double min_quality = 0,
                            const GridSize* tile = nullptr);

}  // namespace imgmesh
