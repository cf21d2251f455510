// A mesh as nothing but a list of faces: slow and plain answers to compare an editable mesh with.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh::test {

inline bool has_vertex(const Face& face, Id v) {
    return std::find(face.begin(), face.end(), v) != face.end();
}

/// The other two corners of a face, in its order.
inline std::pair<Id, Id> others(const Face& face, Id v) {
    const std::size_t i = face[0] == v ? 0 : face[1] == v ? 1 : 2;
    return {face[(i + 1) % 3], face[(i + 2) % 3]};
}

struct Topology {
    std::int64_t vertices = 0, edges = 0, faces = 0;
    std::int64_t boundaries = 0;  ///< closed paths of border edges
    std::int64_t euler() const { return vertices - edges + faces; }
};

/// None where a directed edge has two faces, or a vertex two fans, or a face one vertex twice.
inline std::optional<Topology> topology(const std::vector<Face>& faces) {
    std::set<std::pair<Id, Id>> directed, edges;
    std::map<Id, std::map<Id, Id>> leads;  // at each vertex from one ring vertex to the next
    for (const Face& face : faces)
        for (const Id v : face) {
            const auto [from, to] = others(face, v);
            if (from == to || from == v || to == v || !directed.insert({from, to}).second) return {};
            edges.insert(std::minmax(from, to));
            leads[v][from] = to;
        }
    std::map<Id, Id> border;  // along it, faces on its left; a vertex of one fan is on it once
    for (const auto& [a, b] : directed)
        if (!directed.contains({b, a}) && !border.insert({a, b}).second) return {};
    for (const auto& [v, next] : leads) {
        // From the border on, where there is one, all faces must be reached.
        Id at = border.contains(v) ? border[v] : next.begin()->first;
        std::size_t reached = 0;
        for (; reached < next.size() && next.contains(at); ++reached) at = next.at(at);
        if (reached < next.size()) return {};
    }
    Topology out{static_cast<std::int64_t>(leads.size()), static_cast<std::int64_t>(edges.size()),
                 static_cast<std::int64_t>(faces.size()), 0};
    while (!border.empty()) {
        ++out.boundaries;
        for (auto at = border.begin(); at != border.end();) {
            const Id next = at->second;
            border.erase(at);
            at = border.find(next);
        }
    }
    return out;
}

}  // namespace imgmesh::test
