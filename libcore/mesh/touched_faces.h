// The faces for which what was found before no longer holds.
#pragma once

#include <vector>

#include "libcore/mesh/one_ring.h"

namespace imgmesh {

/// Marks faces that have changed, while results are carried out that hold only until something near them
/// changes. Faces that are added later have changed from the start.
class TouchedFaces {
  public:
    explicit TouchedFaces(std::size_t faces) : touched_(faces, false) {}

    /// There is nothing to touch where the face is kNone.
    bool has(Id f) const { return f != kNone && (f >= touched_.size() || touched_[f]); }
    bool has_any(const OneRing& ring) const {
        for (std::size_t k = 0; k < ring.faces; ++k)
            if (has(ring.face[k])) return true;
        return false;
    }
    void add(Id f) {
        if (f < touched_.size()) touched_[f] = true;
    }
    void add(const OneRing& ring) {
        for (std::size_t k = 0; k < ring.faces; ++k) add(ring.face[k]);
    }

  private:
    std::vector<bool> touched_;
};

}  // namespace imgmesh
