#include "libcore/warp/warp_mesh.h"

#include "libcore/base/error.h"
#include "libcore/warp/cover.h"

namespace imgmesh {
namespace {

// The range that docs/format.md allows.
constexpr float kFarthest = 131072;

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
                add_moves_at(mesh_image.levels[j], moves[j], rest, places[k]);
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
