// Which shapes the triangles around a merged vertex may have.
#pragma once

#include <cmath>
#include <limits>

#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/kernel/neighbor_room.h"

namespace imgmesh {

// Every new triangle keeps 2 area > kFatness longest^2. 0.2 costs 8 % of RMS and lifts the smallest angle
// from 3.6 to 12 degrees; with none, slivers appear.
constexpr float kFatness = 0.05f;

struct ShapeLimits {
    float max_area2 = std::numeric_limits<float>::infinity();  ///< twice the largest area [px^2]
    float min_area2_per_sum = 0;                               ///< least twice-area per sum of squared edges

    /// max_area [px^2]; min_shape: q = 4 sqrt(3) area / sum of squared edges.
    static ShapeLimits of(float max_area, float min_shape) {
        return {2 * max_area, min_shape / (2 * std::sqrt(3.0f))};
    }

    /// Whether a vertex with the ring `ring` may stand at (x, y). border: the ring is an open fan.
    template <class Rings, class Merged>
    bool allow(const Rings& rings, const Merged& ring, bool border, float x, float y) const {
        Corners corners;
        std::size_t n = 0;
        const auto count = static_cast<std::size_t>(ring.valence);
        do {
            const auto& neighbor = rings[ring.neighbor[n]];
            corners.x[n] = neighbor.x;
            corners.y[n] = neighbor.y;
        } while (++n < count);
        corners.x[n] = corners.x[0];
        corners.y[n] = corners.y[0];
        return allow(corners, border ? ring.valence - 1 : ring.valence, x, y);
    }

    /// Positions of a vertex's neighbours, and the first one again behind the last.
    struct Corners {
        float x[kNeighborRoom + 8], y[kNeighborRoom + 8];
    };
    bool allow(const Corners& corners, int faces, float x, float y) const;
};

}  // namespace imgmesh
