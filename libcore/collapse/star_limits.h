// Which shapes the triangles around a merged vertex may have.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "libcore/collapse/ring_mesh.h"

namespace imgmesh {

// Every new triangle keeps 2 area > kFatness longest^2. 0.2 costs 8 % of RMS and lifts the smallest angle
// from 3.6 to 12 degrees; with none, slivers appear.
constexpr float kFatness = 0.05f;

struct StarLimits {
    float max_area2 = std::numeric_limits<float>::infinity();  ///< twice the largest area [px^2]
    float min_area2_per_sum = 0;                               ///< least twice-area per sum of squared edges

    /// max_area [px^2]; min_shape: q = 4 sqrt(3) area / sum of squared edges.
    static StarLimits of(float max_area, float min_shape) {
        return {2 * max_area, min_shape / (2 * std::sqrt(3.0f))};
    }

    /// Whether a vertex with the ring `ring` may stand at (x, y). border: the ring is an open fan.
    bool allow(const RingMesh& rings, const MergedRing& ring, bool border, float x, float y) const {
        const int faces = border ? ring.valence - 1 : ring.valence;
        for (int k = 0; k < faces; ++k) {
            const Ring& a = rings[ring.neighbor[static_cast<std::size_t>(k)]];
            const Ring& b = rings[ring.neighbor[static_cast<std::size_t>(k + 1 == ring.valence ? 0 : k + 1)]];
            const float ax = a.x - x, ay = a.y - y, bx = b.x - x, by = b.y - y, ex = bx - ax, ey = by - ay;
            const float aa = ax * ax + ay * ay, bb = bx * bx + by * by, ee = ex * ex + ey * ey;
            const float area2 = ay * bx - ax * by;
            if (!(area2 > kFatness * std::max({aa, bb, ee})) || area2 > max_area2 ||
                area2 < min_area2_per_sum * (aa + bb + ee))
                return false;
        }
        return true;
    }
};

}  // namespace imgmesh
