// The dense mesh of a masked image as rings.
#pragma once

#include <array>

#include "libcore/mesh/ring_mesh.h"

namespace imgmesh {

/// The vertices of one pixel of a grid mesh with a mask.
struct PixelRings {
    std::array<Ring, 4> ring;
    std::array<Id, 4> vertex;  ///< their numbers, ascending
    std::size_t count = 0;     ///< 0 for a pixel outside
};
PixelRings masked_pixel_rings(const GridMesh& grid, int x, int y);

/// Returns the position of a vertex of the dense mesh, with or without a mask.
Vec2f vertex_place(const GridMesh& grid, Id vertex);

std::int64_t masked_face_count(const GridMesh& grid);

/// Returns how many vertices are on a side and not to stay there, by GridMesh::side_vertices.
std::int64_t side_vertices_to_go(const GridMesh& grid);

/// Returns the rings of a grid mesh with a mask; vertices are numbered as in grid_mesh.h. Vertices of pixels
/// outside have no neighbour. All boundary vertices are marked as corners (kFixedX and kFixedY), but for
/// those that side_vertices takes away; mask_boundary.h decides how a boundary may change.
RingMesh masked_rings(const GridMesh& grid);

}  // namespace imgmesh
