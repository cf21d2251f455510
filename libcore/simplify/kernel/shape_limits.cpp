// Eight triangles at a time, of which each is given by two neighbours that follow each other.
#include "libcore/simplify/kernel/shape_limits.h"

#include "libcore/base/simd.h"
#include "libcore/simplify/kernel/neighbor_room.h"

namespace imgmesh {
namespace {

using Corners = ShapeLimits::Corners;

IMGMESH_INLINE bool allowed(const ShapeLimits& limits, const Corners& corners, int faces, float x, float y) {
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
__attribute__((target("avx2"))) bool allowed_avx2(const ShapeLimits& limits, const Corners& corners,
                                                  int faces, float x, float y) {
    return allowed(limits, corners, faces, x, y);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

bool ShapeLimits::allow(const Corners& corners, int faces, float x, float y) const {
#if defined(__x86_64__)
    if (kAvx2) return allowed_avx2(*this, corners, faces, x, y);
#endif
    return allowed(*this, corners, faces, x, y);
}

}  // namespace imgmesh
