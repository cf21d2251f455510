// The dense mesh of a cut-out as rings.
#pragma once

#include "libcore/collapse/ring_mesh.h"

namespace imgmesh {

/// The rings of a grid mesh with a mask, vertices as grid_mesh.h numbers them; those of pixels outside have
/// no neighbour. All vertices of outlines are corners (kFixedX and kFixedY): what may become of an outline is
/// mask_outline.h's to say.
RingMesh masked_rings(const GridMesh& grid);

}  // namespace imgmesh
