#include "libcore/warp/ordered_mesh.h"

#include <algorithm>
#include <numeric>

namespace imgmesh {

OrderedMesh ordered_mesh(const BaseMesh& mesh) {
    std::vector<Id> order(mesh.vertex_count());
    std::iota(order.begin(), order.end(), Id{0});
    std::ranges::stable_sort(order, is_above, [&](Id v) { return mesh.position[v]; });
    OrderedMesh ordered;
    ordered.mesh.channels = 0;
    ordered.rank.resize(order.size());
    for (const Id v : order) {
        ordered.rank[v] = as_id(ordered.mesh.position.size());
        ordered.mesh.position.push_back(mesh.position[v]);
    }
    for (const Face& face : mesh.faces) {
        Face renamed{ordered.rank[face[0]], ordered.rank[face[1]], ordered.rank[face[2]]};
        std::rotate(renamed.begin(), std::ranges::min_element(renamed), renamed.end());
        ordered.mesh.faces.push_back(renamed);
    }
    std::ranges::sort(ordered.mesh.faces);
    return ordered;
}

}  // namespace imgmesh
