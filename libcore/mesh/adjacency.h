// Finds the faces of a base mesh that share an edge, and those that share a vertex.
#pragma once

#include <span>
#include <vector>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Returns for each face the faces across the edges opposite its corners a, b, c; kNone on a boundary.
std::vector<Face> face_neighbors(const BaseMesh& mesh);

/// For every vertex the corners of faces that it is, each as face * 3 + its place in the face, ascending.
struct VertexCorners {
    std::vector<std::size_t> first;  ///< vertex v has corner[first[v]] to corner[first[v + 1] - 1]
    std::vector<std::size_t> corner;

    std::span<const std::size_t> of(Id v) const {
        return std::span(corner).subspan(first[v], first[v + 1] - first[v]);
    }
};
/// Faces with faces[f][0] == kNone are holes: they have no corners.
VertexCorners vertex_corners(std::span<const Face> faces, std::size_t vertices);

}  // namespace imgmesh
