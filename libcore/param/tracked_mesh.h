// The connectivity of the mesh as a tracker follows it: faces with ids that last, unlike those of the
// collapse's rings, so that pixels can be filed under them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// The faces around a vertex, counter-clockwise: face[k] has the corners (center, ring[k], ring[k + 1]).
struct Star {
    static constexpr int kMax = 12;  ///< as in libcore/mesh/ring_mesh.h

    Id center = kNone;
    std::array<Id, kMax> ring{}, face{};
    int size = 0;       ///< of the ring
    bool open = false;  ///< on a border: no face joins the last ring vertex to the first

    int faces() const { return open ? size - 1 : size; }
    int find(Id vertex) const {
        for (int k = 0; k < size; ++k)
            if (ring[static_cast<std::size_t>(k)] == vertex) return k;
        return -1;
    }
};

class TrackedMesh {
  public:
    /// Faces counter-clockwise, at most Star::kMax at a vertex.
    TrackedMesh(std::vector<Face> faces, std::size_t vertices);

    const Face& corners(Id face) const { return faces_[face]; }
    std::size_t face_count() const { return faces_.size(); }
    std::size_t vertex_count() const { return incident_.size(); }
    bool live(Id vertex) const { return incident_[vertex].size > 0; }
    Star star(Id vertex) const;
    /// Which corner of `face` the vertex is.
    std::size_t corner_of(Id face, Id vertex) const;
    /// The face with the corners a, b, c in this cyclic order.
    Id find(Id a, Id b, Id c) const;

    /// Collapses the edge: faces of both go, those of `removed` become those of `kept`.
    void merge(Id kept, Id removed);

  private:
    struct Incident {
        std::array<Id, Star::kMax> face;
        std::uint32_t size = 0;

        void add(Id f);
        void remove(Id f);
    };
    std::vector<Face> faces_;
    std::vector<Incident> incident_;
};

}  // namespace imgmesh
