// Steps: (1) the other vertices' quadrics, eight at a time, from one record each to one vector a member; (2)
// the closed form of merged_minimum() on all eight.
#include "libcore/simplify/kernel/merge_increments.h"

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
const bool kAvx2 = has_avx2();
#endif

}  // namespace

void merge_increments(const Quadric<3>* quadrics, Id i, Id* others, int count, float* out) {
#if defined(__x86_64__)
    if (kAvx2) return increments_avx2(quadrics, i, others, count, out);
#endif
    increments(quadrics, i, others, count, out);
}

}  // namespace imgmesh
