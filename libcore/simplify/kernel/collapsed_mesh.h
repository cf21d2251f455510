// What a collapse has come to, as a base mesh.
#pragma once

#include <algorithm>
#include <vector>

#include "libcore/mesh/remove_side_vertices.h"
#include "libcore/simplify/kernel/border_rules.h"
#include "libcore/simplify/kernel/quadric_mesh.h"

namespace imgmesh {

/// Returns the mesh, its vertices in the order of the grid mesh.
///
/// channels        of the quadrics
/// sides_decided   vertices that must go from the sides are taken out
template <class Q>
BaseMesh collapsed_mesh(const QuadricMesh<Q>& mesh, int channels, bool sides_decided) {
    BaseMesh out;
    std::vector<Id> order = live_list(mesh.rings);
    if (!mesh.pixel.empty())
        std::sort(order.begin(), order.end(), [&](Id a, Id b) { return mesh.pixel[a] < mesh.pixel[b]; });
    out.channels = channels;
    out.feature.resize(order.size() * static_cast<std::size_t>(channels));
    float* feature = out.feature.data();
    out.faces = ring_faces(mesh.rings, order);
    std::vector<Id> gone;
    for (const Id v : order) {
        const Ring& ring = mesh.rings[v];
        if (sides_decided && must_go(ring)) gone.push_back(static_cast<Id>(out.position.size()));
        out.position.emplace_back(ring.x, ring.y);
        mesh.quadrics[v].features(ring.x, ring.y, feature);
        feature += channels;
    }
    remove_side_vertices(out, gone);
    return out;
}

}  // namespace imgmesh
