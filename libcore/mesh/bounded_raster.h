// Rasterises meshes of any origin.
#pragma once

#include "libcore/mesh/raster.h"

namespace imgmesh {

/// Faces of a sound mesh cover each sample about once; a file may claim thousands of faces over one another.
/// Throws Error(kUnsupported) if the faces and the rows that they cross cover the grid more than 64 times,
/// and `free` samples.
void check_cover(const BaseMesh& mesh, const SampleGrid& grid, double free = 0);

/// Returns rasterize(mesh, grid), after check_cover() with about a million free samples.
PixelMap bounded_raster(const BaseMesh& mesh, const SampleGrid& grid);

}  // namespace imgmesh
