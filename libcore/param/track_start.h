// The dense mesh of an image in the form that a tracker takes.
#pragma once

#include "libcore/mesh/grid_mesh.h"
#include "libcore/param/track.h"

namespace imgmesh {

/// Vertices are those of the collapse of `grid`, the dense mesh of a width x height image. If a side is one
/// pixel, no vertex is a pixel: each pixel lies in the middle of its strip.
TrackStart track_start(const GridMesh& grid, int width, int height);

}  // namespace imgmesh
