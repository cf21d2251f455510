#include "libcore/warp/warp_mesh.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/mesh/bounded_raster.h"
#include "libcore/mesh/trivial_map.h"

namespace imgmesh {
namespace {

// The range that docs/format.md allows.
constexpr float kFarthest = 131072;

// Returns the pixel with a face nearest to a point, searched in growing squares; of equal ones the first.
std::size_t nearest_pixel(const PixelMap& map, const Vec2f& p) {
    const int cx = std::clamp(as_int(std::lround(p.x())), 0, map.width - 1),
              cy = std::clamp(as_int(std::lround(p.y())), 0, map.height - 1);
    std::size_t best = 0;
    float least = INFINITY;
    for (int r = 0; r <= std::max(map.width, map.height) && least == INFINITY; ++r)
        for (int y = std::max(cy - r, 0); y <= std::min(cy + r, map.height - 1); ++y)
            for (int x = std::max(cx - r, 0); x <= std::min(cx + r, map.width - 1); ++x) {
                const std::size_t i = map.index(x, y);
                const float distance = (Vec2f(static_cast<float>(x), static_cast<float>(y)) - p).norm();
                if (map[i].face == kNone || distance >= least) continue;
                least = distance;
                best = i;
            }
    return best;
}

// Adds the moves that the mesh of `level` has at the places `at`. They are linear over each of its faces, in
// the face that covers the pixel nearest to the place. The pixel map is not used: it follows edges of the
// image closely and so changes too fast for vertices. Fine faces would turn over where coarse ones are merely
// stretched.
void add_moves(const Level& level, const VertexMoves& moves, const std::vector<Vec2f>& at,
               std::vector<Vec2f>& sum) {
    check_cover(level.mesh, sample_grid(level.map.width, level.map.height, 1));
    const PixelMap cover = trivial_map(level.mesh, level.map.width, level.map.height);
    for (std::size_t i = 0; i < at.size(); ++i) {
        const PixelCoord& c = cover[nearest_pixel(cover, at[i])];
        if (c.face == kNone) continue;
        const auto [ia, ib, ic] = level.mesh.faces[c.face];
        const Vec2f &pa = level.mesh.position[ia], &pb = level.mesh.position[ib],
                    &pc = level.mesh.position[ic];
        const double area = signed_area2(pa, pb, pc);
        const auto u = static_cast<float>(signed_area2(at[i], pc, pa) / area),
                   v = static_cast<float>(signed_area2(at[i], pa, pb) / area);
        sum[i] += moves[ia] + u * (moves[ib] - moves[ia]) + v * (moves[ic] - moves[ia]);
    }
}

void check_faces(const BaseMesh& mesh, std::size_t level) {
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        const Vec2f &a = mesh.position[mesh.faces[f][0]], &b = mesh.position[mesh.faces[f][1]],
                    &c = mesh.position[mesh.faces[f][2]];
        for (const Vec2f& p : {a, b, c})
            if (!(p.cwiseAbs().maxCoeff() < kFarthest))
                throw Error(ErrorKind::kUnsupported,
                            cat("level ", level, ": a vertex would lie at (", p.x(), ",", p.y(),
                                "), a container holds coordinates below ", kFarthest));
        if (!(signed_area2(a, b, c) > 0))
            throw Error(ErrorKind::kUnsupported,
                        cat("level ", level, ": face ", f, " would turn over near (", a.x(), ",", a.y(),
                            "), and a container holds no such mesh; smaller moves, fewer pins or a finer "
                            "mesh may do"));
    }
}

}  // namespace

MeshImage warp_mesh_image(MeshImage mesh_image, const std::vector<VertexMoves>& moves) {
    std::vector<std::vector<Vec2f>> places(mesh_image.levels.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::vector<Vec2f>& rest = mesh_image.levels[k].mesh.position;
        places[k] = rest;
        for (std::size_t j = 0; j < moves.size(); ++j) {
            if (moves[j].empty()) continue;
            if (j != k)
                add_moves(mesh_image.levels[j], moves[j], rest, places[k]);
            else
                for (Id v = 0; v < rest.size(); ++v) places[k][v] += moves[k][v];
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
