// The dense mesh of an image as a tracker takes it.
#pragma once

#include "libcore/mesh/grid_mesh.h"
#include "libcore/param/track.h"

namespace imgmesh {

/// Vertices as in the collapse of `grid`, the dense mesh of an image of width x height pixels. Where a side
/// is one pixel, no vertex is a pixel: each pixel lies in the middle of its strip.
TrackStart track_start(const GridMesh& grid, int width, int height);

}  // namespace imgmesh
