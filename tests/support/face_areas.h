// The areas of a mesh's faces.
#pragma once

#include <doctest/doctest.h>

#include "libcore/mesh/base_mesh.h"

namespace imgmesh::test {

// Returns the sum of the faces' areas, and checks that none is turned over.
inline double area_of_faces(const BaseMesh& mesh) {
    double twice = 0;
    for (const auto& [a, b, c] : mesh.faces) {
        const double face = signed_area2(mesh.position[a], mesh.position[b], mesh.position[c]);
        CHECK(face > 0);
        twice += face;
    }
    return twice / 2;
}

}  // namespace imgmesh::test
