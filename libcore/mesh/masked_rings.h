// The dense mesh of a masked image as rings.
#pragma once

#include <array>

#include "libcore/mesh/ring_mesh.h"

namespace imgmesh {

/// The vertices of one pixel of a grid mesh with a mask.
struct PixelRings {
    std::array<Ring, 4> ring;
    std::array<Id, 4> vertex;  ///< their numbers, ascending
    std::size_t count = 0;     ///< 0 outside
};
PixelRings masked_pixel_rings(const GridMesh& grid, int x, int y);

/// Where a vertex of the dense mesh is, with or without a mask.
Vec2f vertex_place(const GridMesh& grid, Id vertex);

std::int64_t masked_face_count(const GridMesh& grid);

/// The rings of a grid mesh with a mask, vertices as grid_mesh.h numbers them; those of pixels outside have
/// no neighbour. All vertices of boundaries are corners (kFixedX and kFixedY): what may become of a boundary
/// is mask_boundary.h's to say.
RingMesh masked_rings(const GridMesh& grid);

}  // namespace imgmesh
