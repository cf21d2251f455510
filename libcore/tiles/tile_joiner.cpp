#include "libcore/tiles/tile_joiner.h"

#include "libcore/base/error.h"

namespace imgmesh {

void TileJoiner::add(const BaseMesh& mesh, const Vec2f& corner, const Vec2f& far) {
    if (mesh_.faces.empty()) mesh_.channels = mesh.channels;
    if (mesh.channels != mesh_.channels)
        throw Error(ErrorKind::kBadFile,
                    cat("a tile has ", mesh.channels, " features a vertex and another ", mesh_.channels));
    std::vector<Id> number(mesh.vertex_count());
    for (Id v = 0; v < number.size(); ++v) {
        const Vec2f own = mesh.position[v], place = corner + own;
        number[v] = as_id(mesh_.vertex_count());
        if (own.x() == 0 || own.y() == 0 || own.x() == far.x() || own.y() == far.y()) {
            const auto [entry, is_new] = on_sides_.emplace(std::pair(place.x(), place.y()), number[v]);
            number[v] = entry->second;
            if (!is_new) continue;
        }
        mesh_.position.push_back(place);
        mesh_.feature.insert(mesh_.feature.end(), mesh.feature_of(v), mesh.feature_of(v) + mesh.channels);
    }
    for (const Face& face : mesh.faces)
        mesh_.faces.push_back({number[face[0]], number[face[1]], number[face[2]]});
}

}  // namespace imgmesh
