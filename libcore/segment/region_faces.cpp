#include "libcore/segment/region_faces.h"

#include <algorithm>

#include "libcore/mesh/adjacency.h"

namespace imgmesh {

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
    const std::vector<Face> neighbors = face_neighbors(mesh);
    for (bool changed = true; changed;) {
        changed = false;
        std::vector<Id> next = region;
        for (Id f = 0; f < neighbors.size(); ++f)
            for (const Id g : neighbors[f]) {
                if (region[f] != kNone || g == kNone || region[g] == kNone) continue;
                next[f] = std::min(next[f], region[g]);
                changed = true;
            }
        region = std::move(next);
    }
    return region;
}

}  // namespace imgmesh
