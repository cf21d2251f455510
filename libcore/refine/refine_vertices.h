// What the vertices of a refined mesh have beside their faces.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/edit_mesh.h"

namespace imgmesh {

struct RefineVertices {
    /// Coordinates that a vertex keeps, as bits.
    static constexpr std::uint8_t kFree = 0, kFixedX = 1, kFixedY = 2, kFixed = 3;

    /// `mesh` has three channels. Vertices of its boundary may slide along where the boundary runs straight
    /// on along one side of its bounding box; all others of the boundary are fixed.
    explicit RefineVertices(const BaseMesh& mesh);

    std::vector<Vec2f> position;
    std::vector<Vec3f> color;
    std::vector<std::uint8_t> fixed;

    /// The next vertex, or one whose place is free again.
    void set(Id v, const Vec2f& p, const Vec3f& c, std::uint8_t axes);
};

/// The faces of a base mesh for refinement. Rings inside the mesh begin with the face of the highest id.
EditMesh refine_faces(const BaseMesh& mesh);

/// The live vertices and faces, in the order of their ids.
BaseMesh compact(const EditMesh& mesh, const RefineVertices& vertices);

}  // namespace imgmesh
