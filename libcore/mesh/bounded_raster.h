// Rasterises meshes of any origin.
#pragma once

#include "libcore/mesh/raster.h"

namespace imgmesh {

/// Returns rasterize(mesh, grid). Faces of a sound mesh cover each sample about once; a file may claim
/// thousands of faces over one another. Throws Error(kUnsupported) if the faces and the rows that they cross
/// cover the grid more than 64 times, before any work.
PixelMap bounded_raster(const BaseMesh& mesh, const SampleGrid& grid);

}  // namespace imgmesh
