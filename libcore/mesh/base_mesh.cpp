#include "libcore/mesh/base_mesh.h"

#include <algorithm>

namespace imgmesh {

std::vector<std::pair<Id, Id>> mesh_edges(const BaseMesh& mesh) {
    std::vector<std::pair<Id, Id>> edges;
    edges.reserve(mesh.faces.size() * 3);
    for (const auto& [a, b, c] : mesh.faces)
        for (const auto& [p, q] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            edges.push_back(std::minmax(p, q));
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    return edges;
}

}  // namespace imgmesh
