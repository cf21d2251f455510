#include "libcore/mesh/adjacency.h"

#include <algorithm>
#include <tuple>

namespace imgmesh {

std::vector<Face> face_neighbors(const BaseMesh& mesh) {
    // Sorting the half-edges by their ends brings the two of each edge together.
    struct HalfEdge {
        Id low, high, face;
        std::uint32_t corner;
    };
    std::vector<HalfEdge> half_edges;
    half_edges.reserve(mesh.faces.size() * 3);
    for (Id f = 0; f < mesh.faces.size(); ++f)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const Id p = mesh.faces[f][(k + 1) % 3], q = mesh.faces[f][(k + 2) % 3];
            half_edges.push_back({std::min(p, q), std::max(p, q), f, k});
        }
    std::sort(half_edges.begin(), half_edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return std::tie(a.low, a.high, a.face) < std::tie(b.low, b.high, b.face);
    });
    std::vector<Face> neighbors(mesh.faces.size(), Face{kNone, kNone, kNone});
    for (std::size_t n = 0; n + 1 < half_edges.size(); ++n) {
        const HalfEdge &a = half_edges[n], &b = half_edges[n + 1];
        if (a.low != b.low || a.high != b.high) continue;
        neighbors[a.face][a.corner] = b.face;
        neighbors[b.face][b.corner] = a.face;
    }
    return neighbors;
}

}  // namespace imgmesh
