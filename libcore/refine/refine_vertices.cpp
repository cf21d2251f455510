#include "libcore/refine/refine_vertices.h"

#include "libcore/mesh/adjacency.h"

namespace imgmesh {

RefineVertices::RefineVertices(const BaseMesh& mesh)
    : position(mesh.position), fixed(mesh.vertex_count(), kFree) {
    color.reserve(mesh.vertex_count());
    for (Id v = 0; v < mesh.vertex_count(); ++v) color.emplace_back(mesh.feature_of(v));
    Vec2f low = position.empty() ? Vec2f(0, 0) : position[0], high = low;
    for (const Vec2f& p : position) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    // An end of a border edge may slide only if each border edge at it lies on one and the same side.
    const std::vector<Face> neighbors = face_neighbors(mesh);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            if (neighbors[f][i] != kNone) continue;
            const Id a = mesh.faces[f][(i + 1) % 3], b = mesh.faces[f][(i + 2) % 3];
            const Vec2f &p = position[a], &q = position[b];
            std::uint8_t axes = kFixed;
            if (p.x() == q.x() && (p.x() == low.x() || p.x() == high.x())) axes = kFixedX;
            if (p.y() == q.y() && (p.y() == low.y() || p.y() == high.y())) axes = kFixedY;
            fixed[a] |= axes;
            fixed[b] |= axes;
        }
}

void RefineVertices::set(Id v, const Vec2f& p, const Vec3f& c, std::uint8_t axes) {
    if (v == position.size()) {
        position.emplace_back();
        color.emplace_back();
        fixed.emplace_back();
    }
    position[v] = p;
    color[v] = c;
    fixed[v] = axes;
}

EditMesh refine_faces(const BaseMesh& mesh) {
    EditMesh out(mesh.faces, mesh.vertex_count());
    for (Id f = 0; f < mesh.faces.size(); ++f)
        for (const Id v : mesh.faces[f]) out.begin_ring(v, f);
    return out;
}

BaseMesh compact(const EditMesh& mesh, const RefineVertices& vertices) {
    BaseMesh out;
    std::vector<Id> number(mesh.vertices(), kNone);
    for (Id v = 0; v < mesh.vertices(); ++v) {
        if (!mesh.live_vertex(v)) continue;
        number[v] = static_cast<Id>(out.position.size());
        out.position.push_back(vertices.position[v]);
        out.feature.insert(out.feature.end(), vertices.color[v].data(), vertices.color[v].data() + 3);
    }
    for (const auto& [a, b, c] : mesh.faces())
        if (a != kNone) out.faces.push_back({number[a], number[b], number[c]});
    return out;
}

}  // namespace imgmesh
