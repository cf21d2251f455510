// What the vertices of a refined mesh have besides their faces.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/edit_mesh.h"
#include "libcore/mesh/fixed_axes.h"

namespace imgmesh {

struct RefineVertices {
    static constexpr std::uint8_t kFree = 0;

    /// `mesh` has three channels. tile: as in fixed_axes()
    explicit RefineVertices(const BaseMesh& mesh, const GridSize* tile = nullptr);

    std::vector<Vec2f> position;
    std::vector<Vec3f> color;
    std::vector<std::uint8_t> fixed;  ///< fixed_axes() of the mesh that it was

    /// Adds a vertex, in the place of a removed one if there is one.
    void set(Id v, const Vec2f& p, const Vec3f& c, std::uint8_t axes);
};

/// Returns the faces of a base mesh for refinement. Rings inside the mesh begin with the face of the highest
/// id.
EditMesh refine_faces(const BaseMesh& mesh);

/// Returns the vertices and faces that are not removed, in the order of their ids.
BaseMesh compact(const EditMesh& mesh, const RefineVertices& vertices);

/// Returns the mesh with its vertices numbered from top to bottom, and its faces by their first vertices.
/// Sums over the pixels of a part of the image (param/fit_colors.cpp) take memory for all numbers between.
BaseMesh numbered_downwards(const BaseMesh& mesh);

}  // namespace imgmesh
