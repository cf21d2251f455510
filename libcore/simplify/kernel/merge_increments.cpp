// Steps: (1) the other vertices' quadrics, eight at a time, one in each lane; (2) merged_minimum() on all
// eight.
#include "libcore/simplify/kernel/merge_increments.h"

#include <algorithm>
#include <cstring>

#include "libcore/simplify/quadrics/quadric_lanes.h"

namespace imgmesh {
namespace {

IMGMESH_INLINE void increments(const ColorQuadric* quadrics, Id i, Id* others, int count, float* out) {
    const ColorQuadric8 own = in_every_lane(quadrics[i]);
    // Lanes without a vertex get i itself.
    std::fill(others + count, others + (count + 7) / 8 * 8, i);
    for (int k = 0; k < count; k += 8) {
        const Float8 increment = merged_minimum(own, side_by_side(quadrics, others + k)).increment;
        std::memcpy(out + k, &increment, sizeof increment);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void increments_avx2(const ColorQuadric* quadrics, Id i, Id* others,
                                                     int count, float* out) {
    increments(quadrics, i, others, count, out);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

void merge_increments(const ColorQuadric* quadrics, Id i, Id* others, int count, float* out) {
#if defined(__x86_64__)
    if (kAvx2) return increments_avx2(quadrics, i, others, count, out);
#endif
    increments(quadrics, i, others, count, out);
}

}  // namespace imgmesh
