// What an edit asks of the vertices of its level, before anything is solved. Internal to warp/.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// The vertices of a level that are in handles and pins.
struct HeldVertices {
    std::vector<Vec2d> moves;  ///< of handles [pixels]; 0 for all others
    std::vector<char> held;    ///< whether a vertex is in a handle or a pin

    explicit HeldVertices(std::size_t vertices) : moves(vertices, Vec2d(0, 0)), held(vertices, 0) {}
    void add(const HeldVertices& other);
};

/// Throws as solve_edits() does for everything but levels.
HeldVertices held_vertices(const BaseMesh& mesh, const WarpEdit& edit);

}  // namespace imgmesh
