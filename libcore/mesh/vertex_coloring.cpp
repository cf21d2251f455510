#include "libcore/mesh/vertex_coloring.h"

#include <algorithm>

namespace imgmesh {

std::vector<std::vector<Id>> vertex_coloring(std::span<const Face> faces, std::size_t vertices) {
    std::vector<std::size_t> first(vertices + 1, 0);
    for (const Face& face : faces)
        for (const Id v : face)
            if (face[0] != kNone) ++first[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) first[v + 1] += first[v];
    std::vector<Id> around(first[vertices]);  // faces of each vertex
    std::vector<std::size_t> next(first.begin(), first.end() - 1);
    for (Id f = 0; f < faces.size(); ++f)
        for (const Id v : faces[f])
            if (faces[f][0] != kNone) around[next[v]++] = f;

    std::vector<std::vector<Id>> classes;
    std::vector<Id> class_of(vertices, kNone);
    std::vector<Id> taken_by;  // for each class: the current vertex, if a neighbour of it is in the class
    for (Id v = 0; v < vertices; ++v) {
        if (first[v] == first[v + 1]) continue;
        for (std::size_t k = first[v]; k < first[v + 1]; ++k)
            for (const Id n : faces[around[k]])
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
