// The faces around one vertex.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "libcore/base/types.h"

namespace imgmesh {

/// The faces around a vertex in order, counter-clockwise on screen: face[k] has the corners center, vertex[k]
/// and vertex[k + 1]. The sizes say how much of the arrays is set.
struct OneRing {
    /// A vertex with more has no ring and stays unchanged. The simplifier stops at 12 neighbours
    /// (kMaxValence); with twice as many, 15 degrees are left for each face.
    static constexpr std::size_t kMaxFaces = 24;

    Id center = kNone;
    std::size_t faces = 0;
    bool closed = false;                   ///< the vertex is inside the mesh: the last vertex is the first
    std::array<Id, kMaxFaces + 1> vertex;  ///< faces + 1 of them
    std::array<Id, kMaxFaces> face;
    std::array<std::uint8_t, kMaxFaces> corner;  ///< the corner of the face that the center is

    /// Returns the number of different vertices of the ring.
    std::size_t vertices() const { return closed ? faces : faces + 1; }
    /// Returns the place of a vertex in the ring, or -1.
    int find(Id v) const {
        for (std::size_t k = 0; k < vertices(); ++k)
            if (vertex[k] == v) return static_cast<int>(k);
        return -1;
    }
    /// Returns whether face[k] has the vertex v beside the center.
    bool has(std::size_t k, Id v) const { return vertex[k] == v || vertex[k + 1] == v; }
};

}  // namespace imgmesh
