#include "libcore/refine/refine_vertices.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "libcore/mesh/fixed_axes.h"

namespace imgmesh {

RefineVertices::RefineVertices(const BaseMesh& mesh, const GridSize* tile)
    : position(mesh.position), fixed(fixed_axes(mesh, tile)) {
    color.reserve(mesh.vertex_count());
    for (Id v = 0; v < mesh.vertex_count(); ++v) color.emplace_back(mesh.feature_of(v));
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

BaseMesh numbered_downwards(const BaseMesh& mesh) {
    std::vector<Id> order(mesh.vertex_count()), number(mesh.vertex_count());
    std::iota(order.begin(), order.end(), Id{0});
    std::sort(order.begin(), order.end(), [&](Id a, Id b) {
        const Vec2f &p = mesh.position[a], &q = mesh.position[b];
        return std::tuple(p.y(), p.x(), a) < std::tuple(q.y(), q.x(), b);
    });
    BaseMesh out;
    out.channels = mesh.channels;
    for (const Id v : order) {
        number[v] = static_cast<Id>(out.position.size());
        out.position.push_back(mesh.position[v]);
        out.feature.insert(out.feature.end(), mesh.feature_of(v), mesh.feature_of(v) + mesh.channels);
    }
    for (const auto& [a, b, c] : mesh.faces) out.faces.push_back({number[a], number[b], number[c]});
    std::sort(out.faces.begin(), out.faces.end(), [](const Face& a, const Face& b) {
        return std::tuple(std::min({a[0], a[1], a[2]}), a) < std::tuple(std::min({b[0], b[1], b[2]}), b);
    });
    return out;
}

}  // namespace imgmesh
