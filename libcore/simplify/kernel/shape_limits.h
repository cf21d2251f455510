// Which shapes the triangles around a merged vertex may have.
#pragma once

#include <cmath>
#include <limits>

#include "libcore/base/simd.h"
#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/kernel/neighbor_room.h"

namespace imgmesh {

// Every new triangle keeps 2 area > kFatness longest^2. 0.2 costs 8 % of RMS and lifts the smallest angle
// from 3.6 to 12 degrees; with none, slivers appear.
constexpr float kFatness = 0.05f;

/// Returns whether any lane is not 0.
IMGMESH_INLINE bool any8(const Int8& v) {
    std::int64_t part[4];
    std::memcpy(part, &v, sizeof part);
    return (part[0] | part[1] | part[2] | part[3]) != 0;
}

struct ShapeLimits {
    float max_area2 = std::numeric_limits<float>::infinity();  ///< twice the largest area [px^2]
    float min_area2_per_sum = 0;                               ///< least twice-area per sum of squared edges

    /// max_area [px^2]; min_shape: q = 4 sqrt(3) area / sum of squared edges.
    static ShapeLimits of(float max_area, float min_shape) {
        return {2 * max_area, min_shape / (2 * std::sqrt(3.0f))};
    }

    /// Positions of a vertex's neighbours, x and y in turn, and the first one again behind the last.
    struct Corners {
        float xy[2 * (kNeighborRoom + 8)];
    };
    /// Whether a vertex may stand at (x, y) whose first `faces` triangles have each two of the corners that
    /// follow each other.
    IMGMESH_INLINE bool allow_here(const Corners& corners, int faces, float x, float y) const {
        Int8 bad = {};
        for (int k = 0; k < faces; k += 8) {
            const float* at = corners.xy + 2 * k;
            const Float8 ax = load8_every_other(at) - x, ay = load8_every_other(at + 1) - y;
            const Float8 bx = load8_every_other(at + 2) - x, by = load8_every_other(at + 3) - y;
            const Float8 ex = bx - ax, ey = by - ay;
            const Float8 aa = ax * ax + ay * ay, bb = bx * bx + by * by, ee = ex * ex + ey * ey;
            const Float8 area2 = ay * bx - ax * by;
            const Float8 most = aa > bb ? aa : bb, longest = most > ee ? most : ee;
            const Int8 good = (area2 > kFatness * longest) & (area2 <= max_area2) &
                              (area2 >= min_area2_per_sum * (aa + bb + ee));
            bad |= ~good & (Int8{0, 1, 2, 3, 4, 5, 6, 7} < faces - k);
        }
        return !any8(bad);
    }
    /// The same with SIMD where the processor has it.
    bool allow(const Corners& corners, int faces, float x, float y) const;

    /// Whether a vertex with the ring `ring` may stand at (x, y). border: the ring is an open fan.
    template <class Rings, class Merged>
    bool allow(const Rings& rings, const Merged& ring, bool border, float x, float y) const {
        Corners corners;
        const auto count = static_cast<std::size_t>(ring.valence);
        std::size_t n = 0;
        do {
            const auto& neighbor = rings[ring.neighbor[n]];
            corners.xy[2 * n] = neighbor.x;
            corners.xy[2 * n + 1] = neighbor.y;
        } while (++n < count);
        corners.xy[2 * n] = corners.xy[0];
        corners.xy[2 * n + 1] = corners.xy[1];
        return allow(corners, border ? ring.valence - 1 : ring.valence, x, y);
    }
};

}  // namespace imgmesh
