#include "libcore/collapse/edge_batch.h"

namespace imgmesh {

inline __attribute__((always_inline)) Quadric<3> EdgeBatch<Quadric<3>>::column(const Lanes& lanes, int lane) {
    Quadric<3> q;
    q.px = lanes[0][lane];
    q.py = lanes[1][lane];
    for (int c = 0; c < 3; ++c) {
        q.s[c] = lanes[2 + c][lane];
        q.gx[c] = lanes[5 + c][lane];
        q.gy[c] = lanes[8 + c][lane];
    }
    q.sxx = lanes[11][lane];
    q.sxy = lanes[12][lane];
    q.syy = lanes[13][lane];
    q.weight = lanes[14][lane];
    q.error = lanes[15][lane];
    return q;
}

// The compiler turns the loop into vector code of whatever width its caller is built for.
inline __attribute__((always_inline)) void EdgeBatch<Quadric<3>>::evaluate_lanes() {
    for (int lane = 0; lane < kWidth; ++lane)
        increment_[lane] = merged_minimum(column(i_, lane), column(j_, lane)).increment;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void EdgeBatch<Quadric<3>>::evaluate_avx2() {
    evaluate_lanes();
}
#endif

void EdgeBatch<Quadric<3>>::evaluate() {
#if defined(__x86_64__)
    static const bool kAvx2 = __builtin_cpu_supports("avx2");
    if (kAvx2) return evaluate_avx2();
#endif
    evaluate_lanes();
}

}  // namespace imgmesh
