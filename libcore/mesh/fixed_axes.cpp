#include "libcore/mesh/fixed_axes.h"

#include "libcore/mesh/adjacency.h"
#include "libcore/mesh/tile_sides.h"

namespace imgmesh {

std::vector<std::uint8_t> fixed_axes(const BaseMesh& mesh, const GridSize* tile) {
    std::vector<std::uint8_t> fixed(mesh.vertex_count(), 0);
    if (mesh.position.empty()) return fixed;
    Vec2f low = mesh.position[0], high = low;
    for (const Vec2f& p : mesh.position) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    // An end of a boundary edge may slide only if each boundary edge at it lies on one and the same side.
    const std::vector<Face> neighbors = face_neighbors(mesh);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            if (neighbors[f][i] != kNone) continue;
            const Id a = mesh.faces[f][(i + 1) % 3], b = mesh.faces[f][(i + 2) % 3];
            const Vec2f &p = mesh.position[a], &q = mesh.position[b];
            std::uint8_t axes = kFixedX | kFixedY;
            if (p.x() == q.x() && (p.x() == low.x() || p.x() == high.x())) axes = kFixedX;
            if (p.y() == q.y() && (p.y() == low.y() || p.y() == high.y())) axes = kFixedY;
            fixed[a] |= axes;
            fixed[b] |= axes;
        }
    for (Id v = 0; tile && v < mesh.vertex_count(); ++v)
        if (on_side(mesh.position[v], tile->width, tile->height)) fixed[v] = kFixedX | kFixedY | kFixedColor;
    return fixed;
}

}  // namespace imgmesh
