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

VertexCorners vertex_corners(std::span<const Face> faces, std::size_t vertices) {
    VertexCorners out;
    out.first.assign(vertices + 1, 0);
    for (const Face& face : faces)
        for (const Id v : face)
            if (face[0] != kNone) ++out.first[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) out.first[v + 1] += out.first[v];
    out.corner.resize(out.first[vertices]);
    std::vector<std::size_t> next(out.first.begin(), out.first.end() - 1);
    for (std::size_t f = 0; f < faces.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            if (faces[f][0] != kNone) out.corner[next[faces[f][k]]++] = f * 3 + k;
    return out;
}

}  // namespace imgmesh
