#include "libcore/mesh/pixel_run.h"

namespace imgmesh {
namespace {

using Double4 = double __attribute__((vector_size(32)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

IMGMESH_INLINE Double4 load4(const double* p) {
    Double4 v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
IMGMESH_INLINE void store4(float* p, Double4 values) {
    const Float4 v = __builtin_convertvector(values, Float4);
    std::memcpy(p, &v, sizeof v);
}

// 1 where `mask` is set, 0 elsewhere.
template <typename Mask4>
IMGMESH_INLINE Double4 ones(Mask4 mask) {
    return mask ? Double4{1, 1, 1, 1} : Double4{};
}

// Returns floor(side / area), and leaves the remainder in `side`. The quotient of doubles may be off by one.
IMGMESH_INLINE Double4 quotient(Double4& side, Double4 area, Double4 inverse) {
    const Double4 q = __builtin_convertvector(__builtin_convertvector(side * inverse, Int4), Double4);
    const Double4 rest = side - q * area;
    const Double4 step = ones(rest >= area) - ones(rest < 0);
    side = rest - step * area;
    return q + step;
}

}  // namespace

struct PixelRun::Lanes {
    static IMGMESH_INLINE void divide(PixelRun& run, int count) {
        const double step = 1 / static_cast<double>(1 << run.bits_);
        for (int i = 0; i < count; i += 4) {
            const Double4 area = load4(run.area_ + i), inverse = 1 / area;
            Double4 rest_b = load4(run.b_ + i), rest_c = load4(run.c_ + i);
            const Double4 b = quotient(rest_b, area, inverse), c = quotient(rest_c, area, inverse);
            // Remainders are multiples of 4 and the precedence, 3 in all. Without it they sum to `left`
            // areas.
            const Double4 both = rest_b + rest_c;
            const Double4 left = ones(both >= 4) + ones(both >= area + 4);
            const Double4 rest_a = left * area - both + 3;
            const Double4 before_b = ones(rest_a > rest_b) + ones(rest_c > rest_b);
            const Double4 before_c = ones(rest_a > rest_c) + ones(rest_b > rest_c);
            store4(run.u_ + i, (b + ones(before_b < left)) * step);
            store4(run.v_ + i, (c + ones(before_c < left)) * step);
        }
    }

#if defined(__x86_64__)
    __attribute__((target("avx2"))) static void divide_avx2(PixelRun& run, int count) {
        divide(run, count);
    }
    inline static const bool kAvx2 = has_avx2();
#endif
};

void PixelRun::divide(int count) {
#if defined(__x86_64__)
    if (Lanes::kAvx2) return Lanes::divide_avx2(*this, count);
#endif
    Lanes::divide(*this, count);
}

}  // namespace imgmesh
