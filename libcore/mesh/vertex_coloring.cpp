#include "libcore/mesh/vertex_coloring.h"

#include <algorithm>

#include "libcore/mesh/adjacency.h"

namespace imgmesh {

std::vector<std::vector<Id>> vertex_coloring(std::span<const Face> faces, std::size_t vertices) {
    const VertexCorners corners = vertex_corners(faces, vertices);
    std::vector<std::vector<Id>> classes;
    std::vector<Id> class_of(vertices, kNone);
    std::vector<Id> taken_by;  // for each class: the current vertex, if a neighbour of it is in the class
    for (Id v = 0; v < vertices; ++v) {
        if (corners.of(v).empty()) continue;
        for (const std::size_t corner : corners.of(v))
            for (const Id n : faces[corner / 3])
                if (class_of[n] != kNone) taken_by[class_of[n]] = v;
        const auto free = std::find_if(taken_by.begin(), taken_by.end(), [v](Id by) { return by != v; });
        class_of[v] = as_id(free - taken_by.begin());
        if (free == taken_by.end()) {
            taken_by.push_back(kNone);
            classes.emplace_back();
        }
        classes[class_of[v]].push_back(v);
    }
    return classes;
}

}  // namespace imgmesh
