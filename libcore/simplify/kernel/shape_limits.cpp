// Eight triangles at a time.
#include "libcore/simplify/kernel/shape_limits.h"

namespace imgmesh {
namespace {

#if defined(__x86_64__)
__attribute__((target("avx2"))) bool allow_avx2(const ShapeLimits& limits,
                                                const ShapeLimits::Corners& corners, int faces, float x,
                                                float y) {
    return limits.allow_here(corners, faces, x, y);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

bool ShapeLimits::allow(const Corners& corners, int faces, float x, float y) const {
#if defined(__x86_64__)
    if (kAvx2) return allow_avx2(*this, corners, faces, x, y);
#endif
    return allow_here(corners, faces, x, y);
}

}  // namespace imgmesh
