// Meshes whose vertices and faces stand in an order of their own.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Whether a place comes before another: from top to bottom, from left to right.
inline bool is_above(const Vec2f& a, const Vec2f& b) {
    return a.y() != b.y() ? a.y() < b.y() : a.x() < b.x();
}

/// A mesh with its vertices sorted by is_above(), and its faces by their vertices, the first of which is the
/// first corner. Sums round differently in another order, and containers change the order of vertices and
/// faces. What is computed on this mesh is the same before and after. It has no features.
struct OrderedMesh {
    BaseMesh mesh;
    std::vector<Id> rank;  ///< the number in `mesh` of every vertex; those at one place keep their order
};
OrderedMesh ordered_mesh(const BaseMesh& mesh);

}  // namespace imgmesh
