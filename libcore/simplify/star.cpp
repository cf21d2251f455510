#include "libcore/simplify/star.h"

#include <algorithm>
#include <cstring>

#include "libcore/base/simd.h"

namespace imgmesh {
namespace {

// Eight quadrics side by side.
IMGMESH_INLINE Quadric<3, Float8> side_by_side(const Quadric<3>* quadrics, const Id* which) {
    Float8 low[8], high[8];
    for (int lane = 0; lane < 8; ++lane) {
        low[lane] = load8(&quadrics[which[lane]].px);
        high[lane] = load8(&quadrics[which[lane]].px + 8);
    }
    transpose8(low);
    transpose8(high);
    Quadric<3, Float8> q;
    q.px = low[0];
    q.py = low[1];
    for (int c = 0; c < 3; ++c) {
        q.s[c] = low[2 + c];
        q.gx[c] = low[5 + c];
        q.gy[c] = high[c];
    }
    q.sxx = high[3];
    q.sxy = high[4];
    q.syy = high[5];
    q.weight = high[6];
    q.error = high[7];
    return q;
}

// The same one in every lane.
IMGMESH_INLINE Quadric<3, Float8> everywhere(const Quadric<3>& quadric) {
    const Float8 zero = {};
    Quadric<3, Float8> q;
    q.px = zero + quadric.px;
    q.py = zero + quadric.py;
    for (int c = 0; c < 3; ++c) {
        q.s[c] = zero + quadric.s[c];
        q.gx[c] = zero + quadric.gx[c];
        q.gy[c] = zero + quadric.gy[c];
    }
    q.sxx = zero + quadric.sxx;
    q.sxy = zero + quadric.sxy;
    q.syy = zero + quadric.syy;
    q.weight = zero + quadric.weight;
    q.error = zero + quadric.error;
    return q;
}

IMGMESH_INLINE void increments(const Quadric<3>* quadrics, Id i, Id* others, int count, float* out) {
    const Quadric<3, Float8> own = everywhere(quadrics[i]);
    std::fill(others + count, others + (count + 7) / 8 * 8, i);
    for (int k = 0; k < count; k += 8) {
        const Float8 increment = merged_minimum(own, side_by_side(quadrics, others + k)).increment;
        std::memcpy(out + k, &increment, sizeof increment);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void increments_avx2(const Quadric<3>* quadrics, Id i, Id* others, int count,
                                                     float* out) {
    increments(quadrics, i, others, count, out);
}
#endif

// Positions of a vertex's neighbours, and the first one again behind the last.
struct Corners {
    float x[kStarRoom + 8], y[kStarRoom + 8];
};

IMGMESH_INLINE bool allowed(const StarLimits& limits, const Corners& corners, int faces, float x, float y) {
    Int8 bad = {};
    for (int k = 0; k < faces; k += 8) {
        const Float8 ax = load8(corners.x + k) - x, ay = load8(corners.y + k) - y;
        const Float8 bx = load8(corners.x + k + 1) - x, by = load8(corners.y + k + 1) - y;
        const Float8 ex = bx - ax, ey = by - ay;
        const Float8 aa = ax * ax + ay * ay, bb = bx * bx + by * by, ee = ex * ex + ey * ey;
        const Float8 area2 = ay * bx - ax * by;
        const Float8 most = aa > bb ? aa : bb, longest = most > ee ? most : ee;
        const Int8 good = (area2 > kFatness * longest) & (area2 <= limits.max_area2) &
                          (area2 >= limits.min_area2_per_sum * (aa + bb + ee));
        bad |= ~good & (Int8{0, 1, 2, 3, 4, 5, 6, 7} < faces - k);
    }
    int any = 0;
    for (int l = 0; l < 8; ++l) any |= bad[l];
    return any == 0;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) bool allowed_avx2(const StarLimits& limits, const Corners& corners, int faces,
                                                  float x, float y) {
    return allowed(limits, corners, faces, x, y);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

bool StarLimits::allow(const RingMesh& rings, const MergedRing& ring, bool border, float x, float y) const {
    Corners corners;
    std::size_t n = 0;
    for (const auto count = static_cast<std::size_t>(ring.valence); n < count; ++n) {
        const Ring& neighbor = rings[ring.neighbor[n]];
        corners.x[n] = neighbor.x;
        corners.y[n] = neighbor.y;
    }
    corners.x[n] = corners.x[0];
    corners.y[n] = corners.y[0];
    const int faces = border ? ring.valence - 1 : ring.valence;
#if defined(__x86_64__)
    if (kAvx2) return allowed_avx2(*this, corners, faces, x, y);
#endif
    return allowed(*this, corners, faces, x, y);
}

void star_increments(const Quadric<3>* quadrics, Id i, Id* others, int count, float* out) {
#if defined(__x86_64__)
    if (kAvx2) return increments_avx2(quadrics, i, others, count, out);
#endif
    increments(quadrics, i, others, count, out);
}

}  // namespace imgmesh
