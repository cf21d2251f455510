// The triangles of a grid mesh and the rings of a triangle list, written a second time in the simplest way,
// as the reference for the fast ones.
#pragma once

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/ring_mesh.h"

namespace imgmesh::test {

/// The two triangles of each cell, counter-clockwise on screen (y down: down first, then right).
inline std::vector<Face> grid_faces(const GridMesh& grid) {
    const int w = grid.feature.width, h = grid.feature.height;
    std::vector<Face> faces;
    for (int y = 0; y + 1 < h; ++y)
        for (int x = 0; x + 1 < w; ++x) {
            const Id tl = static_cast<Id>(y * w + x), tr = tl + 1, bl = tl + static_cast<Id>(w), br = bl + 1;
            if (grid.falling_diagonal(x, y)) {
                faces.push_back({tl, bl, br});
                faces.push_back({tl, br, tr});
            } else {
                faces.push_back({tl, bl, tr});
                faces.push_back({tr, bl, br});
            }
        }
    return faces;
}

/// Each face from its corner of the lowest id, in ascending order.
inline std::vector<Face> in_standard_order(std::vector<Face> faces) {
    for (Face& face : faces)
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    std::sort(faces.begin(), faces.end());
    return faces;
}

/// The neighbours of `v` in counter-clockwise order. A closed fan starts at its lowest id, an open one (on
/// the border) at the neighbour that no face precedes.
inline std::vector<Id> ring_of(const std::vector<Face>& faces, Id v, bool& border) {
    std::map<Id, Id> next;
    std::set<Id> preceded;
    for (const Face& face : faces)
        for (std::size_t k = 0; k < 3; ++k)
            if (face[k] == v) {
                next[face[(k + 1) % 3]] = face[(k + 2) % 3];
                preceded.insert(face[(k + 2) % 3]);
            }
    std::vector<Id> ring;
    if (next.empty()) return ring;
    Id start = next.begin()->first;
    border = false;
    for (const auto& [from, to] : next)
        if (!preceded.contains(from)) {
            start = from;
            border = true;
        }
    ring.push_back(start);
    for (auto at = next.find(start); at != next.end() && at->second != start; at = next.find(at->second))
        ring.push_back(at->second);
    return ring;
}

/// The neighbours that `ring` holds, rotated as ring_of() does.
inline std::vector<Id> neighbors_of(const Ring& ring) {
    std::vector<Id> out(ring.neighbor, ring.neighbor + ring.valence);
    if (!ring.border() && !out.empty())
        std::rotate(out.begin(), std::min_element(out.begin(), out.end()), out.end());
    return out;
}

/// A ring mesh of any triangle list, for cases made by hand. Positions are 0; border vertices count as fixed.
inline RingMesh rings_of(const std::vector<Face>& faces, Id vertices) {
    RingMesh rings(vertices);
    for (Id v = 0; v < vertices; ++v) {
        bool border = false;
        const std::vector<Id> ring = ring_of(faces, v, border);
        std::copy(ring.begin(), ring.end(), rings[v].neighbor);
        rings[v].valence = static_cast<std::uint8_t>(ring.size());
        rings[v].fixed = border ? kFixedX : 0;
    }
    return rings;
}

}  // namespace imgmesh::test
