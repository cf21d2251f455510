#include "libcore/warp/warp_mesh.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/warp/displacement.h"

namespace imgmesh {
namespace {

// What docs/format.md allows.
constexpr float kFarthest = 131072;

// The inside pixel nearest to a point, searched in growing squares; of equal ones the first.
std::size_t nearest_pixel(const PixelMap& map, const Vec2f& p) {
    const int cx = std::clamp(static_cast<int>(std::lround(p.x())), 0, map.width - 1),
              cy = std::clamp(static_cast<int>(std::lround(p.y())), 0, map.height - 1);
    std::size_t best = 0;
    float least = INFINITY;
    for (int r = 0; r <= std::max(map.width, map.height) && least == INFINITY; ++r)
        for (int y = std::max(cy - r, 0); y <= std::min(cy + r, map.height - 1); ++y)
            for (int x = std::max(cx - r, 0); x <= std::min(cx + r, map.width - 1); ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width) +
                                      static_cast<std::size_t>(x);
                const float distance = (Vec2f(static_cast<float>(x), static_cast<float>(y)) - p).norm();
                if (map.coords[i].face == kNone || distance >= least) continue;
                least = distance;
                best = i;
            }
    return best;
}

// For every vertex the pixel with the largest weight of it, the first of equal ones.
std::vector<std::size_t> pixels_at_vertices(const Level& level) {
    const BaseMesh& mesh = level.mesh;
    std::vector<std::size_t> pixel(mesh.vertex_count());
    std::vector<float> largest(mesh.vertex_count(), 0.0f);
    for (std::size_t i = 0; i < level.map.coords.size(); ++i) {
        const PixelCoord& c = level.map.coords[i];
        if (c.face == kNone) continue;
        const float weight[3] = {1 - c.u - c.v, c.u, c.v};
        for (std::size_t k = 0; k < 3; ++k) {
            const Id v = mesh.faces[c.face][k];
            if (weight[k] <= largest[v]) continue;
            largest[v] = weight[k];
            pixel[v] = i;
        }
    }
    for (Id v = 0; v < pixel.size(); ++v)
        if (largest[v] == 0) pixel[v] = nearest_pixel(level.map, mesh.position[v]);
    return pixel;
}

void check_faces(const BaseMesh& mesh, std::size_t level) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec2f &a = mesh.position[mesh.faces[f][0]], &b = mesh.position[mesh.faces[f][1]],
                    &c = mesh.position[mesh.faces[f][2]];
        for (const Vec2f& p : {a, b, c})
            if (!(p.cwiseAbs().maxCoeff() < kFarthest))
                throw Error(ErrorCode::kUnsupported,
                            cat("level ", level, ": a vertex would lie at (", p.x(), ",", p.y(),
                                "), a container holds coordinates below ", kFarthest));
        if (!(signed_area2(a, b, c) > 0))
            throw Error(ErrorCode::kUnsupported, cat("level ", level, ": face ", f, " would turn over near (",
                                                     a.x(), ",", a.y(), "), a container holds no such mesh"));
    }
}

}  // namespace

MeshImage warp_mesh_image(MeshImage mesh_image, const std::vector<VertexMoves>& moves) {
    std::vector<std::vector<Vec2f>> places(mesh_image.levels.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const Level& level = mesh_image.levels[k];
        std::vector<VertexMoves> others = moves;
        others[k].clear();
        places[k] = level.mesh.position;
        if (!moves[k].empty())
            for (Id v = 0; v < places[k].size(); ++v) places[k][v] += moves[k][v];
        if (std::any_of(others.begin(), others.end(), [](const VertexMoves& m) { return !m.empty(); })) {
            const DisplacementField field = displacement_field(mesh_image, others);
            const std::vector<std::size_t> pixel = pixels_at_vertices(level);
            for (Id v = 0; v < places[k].size(); ++v) places[k][v] += field.move[pixel[v]];
        }
    }
    for (std::size_t k = 0; k < places.size(); ++k) {
        BaseMesh& mesh = mesh_image.levels[k].mesh;
        for (Id v = 0; v < places[k].size(); ++v)
            mesh.position[v] = {snapped(places[k][v].x()), snapped(places[k][v].y())};
        check_faces(mesh, k);
    }
    auto& parameters = mesh_image.parameters;
    std::erase_if(parameters, [](const BuildParameter& p) { return p.first == "warp"; });
    parameters.emplace_back("warp", true);
    return mesh_image;
}

}  // namespace imgmesh
