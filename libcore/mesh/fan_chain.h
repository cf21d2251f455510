// The neighbours of one vertex in order, and the corners between them that can be cut off: to flip the edge
// from the vertex to a neighbour leaves a triangle of that neighbour and the two beside it.
#pragma once

#include <algorithm>
#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/edit_mesh.h"

namespace imgmesh {

/// Returns the neighbours of v counter-clockwise on screen: around a vertex inside the mesh from any of them
/// on, on the boundary from one end of the fan to the other.
///
/// fan  the faces at v, a single fan
inline std::vector<Id> fan_chain(const BaseMesh& mesh, Id v, const std::vector<Id>& fan) {
    std::vector<std::pair<Id, Id>> steps;
    for (const Id f : fan) {
        const Face& face = mesh.faces[f];
        const std::size_t c = corner_of(face, v);
        steps.emplace_back(face[(c + 1) % 3], face[(c + 2) % 3]);
    }
    const auto begins_fan = [&](const auto& step) {
        return std::none_of(steps.begin(), steps.end(),
                            [&](const auto& s) { return s.second == step.first; });
    };
    const auto first = std::find_if(steps.begin(), steps.end(), begins_fan);
    const bool closed = first == steps.end();
    std::vector<Id> chain{closed ? steps.front().first : first->first};
    while (chain.size() < steps.size() + (closed ? 0 : 1)) {
        const auto next =
            std::find_if(steps.begin(), steps.end(), [&](const auto& s) { return s.first == chain.back(); });
        if (next == steps.end()) break;
        chain.push_back(next->second);
    }
    return chain;
}

/// Returns twice the area of triangle (a, b, c) over the square of its longest edge, with the area's sign.
inline double corner_shape(const BaseMesh& mesh, Id a, Id b, Id c) {
    const Vec2f &p = mesh.position[a], &q = mesh.position[b], &r = mesh.position[c];
    const double longest = std::max({(q - p).squaredNorm(), (r - q).squaredNorm(), (p - r).squaredNorm()});
    return signed_area2(p, q, r) / longest;
}

}  // namespace imgmesh
