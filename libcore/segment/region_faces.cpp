#include "libcore/segment/region_faces.h"

#include <algorithm>
#include <tuple>

namespace imgmesh {
namespace {

// Faces at each edge as sorted triples: the edge's lower vertex, its higher vertex, a face.
using EdgeFaces = std::vector<std::tuple<Id, Id, Id>>;

EdgeFaces edge_faces(const BaseMesh& mesh) {
    EdgeFaces all;
    for (Id f = 0; f < mesh.faces.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) {
            const Id a = mesh.faces[f][i], b = mesh.faces[f][(i + 1) % 3];
            all.emplace_back(std::min(a, b), std::max(a, b), f);
        }
    std::sort(all.begin(), all.end());
    return all;
}

// Returns all pairs of faces with a common edge, in both orders, sorted.
std::vector<std::pair<Id, Id>> face_neighbors(const BaseMesh& mesh) {
    const EdgeFaces edges = edge_faces(mesh);
    std::vector<std::pair<Id, Id>> pairs;
    for (std::size_t i = 1; i < edges.size(); ++i) {
        const auto& [a, b, f] = edges[i - 1];
        const auto& [c, d, g] = edges[i];
        if (a != c || b != d) continue;
        pairs.emplace_back(f, g);
        pairs.emplace_back(g, f);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

}  // namespace

std::vector<Id> region_of_faces(const BaseMesh& mesh, const PixelMap& map, const LabelImage& labels) {
    std::vector<std::pair<Id, Id>> owned;  // one pair (face, region) for each pixel
    for (std::size_t i = 0; i < map.size(); ++i)
        if (map[i].face != kNone) owned.emplace_back(map[i].face, labels[i]);
    std::sort(owned.begin(), owned.end());
    std::vector<Id> region(mesh.faces.size(), kNone);
    std::vector<std::size_t> most(mesh.faces.size(), 0);
    for (std::size_t i = 0, end; i < owned.size(); i = end) {
        for (end = i; end < owned.size() && owned[end] == owned[i];) ++end;
        const auto [face, label] = owned[i];
        if (end - i <= most[face]) continue;
        most[face] = end - i;
        region[face] = label;
    }
    // Works outwards in rounds, so that ties go to the lowest region whatever the order of the faces.
    const std::vector<std::pair<Id, Id>> neighbors = face_neighbors(mesh);
    for (bool changed = true; changed;) {
        changed = false;
        std::vector<Id> next = region;
        for (const auto& [f, g] : neighbors) {
            if (region[f] != kNone || region[g] == kNone) continue;
            next[f] = std::min(next[f], region[g]);
            changed = true;
        }
        region = std::move(next);
    }
    return region;
}

}  // namespace imgmesh
