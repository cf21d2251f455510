#include "libcore/param/tracked_mesh.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace imgmesh {

void TrackedMesh::Incident::add(Id f) {
    assert(size < Star::kMax);
    face[size++] = f;
}

void TrackedMesh::Incident::remove(Id f) {
    Id* const end = face.data() + size;
    Id* const at = std::find(face.data(), end, f);
    assert(at != end);
    std::copy(at + 1, end, at);
    --size;
}

TrackedMesh::TrackedMesh(std::vector<Face> faces, std::size_t vertices)
    : faces_(std::move(faces)), incident_(vertices) {
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (const Id v : faces_[f]) incident_[v].add(static_cast<Id>(f));
}

std::size_t TrackedMesh::corner_of(Id face, Id vertex) const {
    const Face& corners = faces_[face];
    assert(corners[0] == vertex || corners[1] == vertex || corners[2] == vertex);
    return corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
}

Star TrackedMesh::star(Id vertex) const {
    const Incident& incident = incident_[vertex];
    const std::size_t n = incident.size;
    assert(n > 0);
    // Each face leads from one ring vertex to the next.
    std::array<Id, Star::kMax> from{}, to{};
    for (std::size_t k = 0; k < n; ++k) {
        const std::size_t at = corner_of(incident.face[k], vertex);
        from[k] = faces_[incident.face[k]][(at + 1) % 3];
        to[k] = faces_[incident.face[k]][(at + 2) % 3];
    }
    const auto leaving = [&](Id v) {
        return static_cast<std::size_t>(std::find(from.begin(), from.begin() + n, v) - from.begin());
    };
    Star star;
    star.center = vertex;
    std::size_t next = 0;
    for (std::size_t k = 0; k < n; ++k)
        if (std::find(to.begin(), to.begin() + n, from[k]) == to.begin() + n) {
            star.open = true;
            next = k;
        }
    for (std::size_t k = 0; k < n; ++k) {
        assert(next < n);
        star.ring[k] = from[next];
        star.face[k] = incident.face[next];
        if (k + 1 == n && star.open) star.ring[n] = to[next];
        next = leaving(to[next]);
    }
    star.size = static_cast<int>(star.open ? n + 1 : n);
    return star;
}

Id TrackedMesh::find(Id a, Id b, Id c) const {
    for (std::uint32_t k = 0; k < incident_[a].size; ++k) {
        const Id f = incident_[a].face[k];
        const std::size_t at = corner_of(f, a);
        if (faces_[f][(at + 1) % 3] == b && faces_[f][(at + 2) % 3] == c) return f;
    }
    return kNone;
}

void TrackedMesh::merge(Id kept, Id removed) {
    const Incident old = incident_[removed];
    for (std::uint32_t k = 0; k < old.size; ++k) {
        const Id f = old.face[k];
        Face& corners = faces_[f];
        if (std::find(corners.begin(), corners.end(), kept) == corners.end()) {
            corners[corner_of(f, removed)] = kept;
            continue;
        }
        for (const Id v : corners)
            if (v != removed) incident_[v].remove(f);
    }
    for (std::uint32_t k = 0; k < old.size; ++k) {
        const Face& corners = faces_[old.face[k]];
        if (std::find(corners.begin(), corners.end(), removed) == corners.end())
            incident_[kept].add(old.face[k]);
    }
    incident_[removed].size = 0;
}

}  // namespace imgmesh
