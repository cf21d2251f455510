#include "libcore/recon/svg_places.h"

#include "libcore/mesh/outer_edge.h"

namespace imgmesh {

std::vector<Vec2d> outward(const Level& level, const SourceInfo& source) {
    const BaseMesh& mesh = level.mesh;
    std::vector<Vec2d> points;
    points.reserve(mesh.vertex_count());
    if (source.has_mask) {
        for (const Vec2f& p : outer_positions(mesh, level.map)) points.push_back(p.cast<double>());
        return points;
    }
    const auto moved = [&](float x, int side) {
        if (side == 1) return double(x);  // already -0.5 .. 0.5
        if (x <= 0) return x - 0.5;
        return x >= static_cast<float>(side - 1) ? x + 0.5 : double(x);
    };
    for (const Vec2f& p : mesh.position)
        points.emplace_back(moved(p.x(), source.width), moved(p.y(), source.height));
    return points;
}

}  // namespace imgmesh
