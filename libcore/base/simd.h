// Eight floats side by side, in the compiler's own vector types: two SSE registers, or one AVX2 register
// inside a function built for it. Arithmetic, comparison and selection (mask ? a : b) are operators of the
// language and work lane by lane.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace imgmesh {

using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));

// Such vectors must not be passed between functions built for different processors, so everything here is
// inlined.
#define IMGMESH_INLINE inline __attribute__((always_inline))

IMGMESH_INLINE Float8 load8(const float* p) {
    Float8 v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
/// Returns p[0], p[2], ... p[14]; reads p[15] too.
IMGMESH_INLINE Float8 load8_every_other(const float* p) {
    return __builtin_shufflevector(load8(p), load8(p + 8), 0, 2, 4, 6, 8, 10, 12, 14);
}

/// Says whether every lane of a comparison's result is true.
IMGMESH_INLINE bool all_set(Int8 mask) {
    int all = -1;
    for (int l = 0; l < 8; ++l) all &= mask[l];
    return all != 0;
}

/// Says whether functions built for AVX2 may be called. This is decided in one place, so that a test program
/// can define its own and take the other path: results are the same bytes on both.
bool has_avx2();

/// Returns a number whose bit k is set if values[k] is `wanted`, for 0 <= k < 12.
inline unsigned match12(const std::uint32_t* values, std::uint32_t wanted) {
#if defined(__SSE2__)
    const __m128i w = _mm_set1_epi32(static_cast<int>(wanted));
    const auto four = [&](int k) {
        return _mm_cmpeq_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(values + k)), w);
    };
    const __m128i eight = _mm_packs_epi32(four(0), four(4)), last = _mm_packs_epi32(four(8), __m128i{});
    return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(eight, last)));
#else
    unsigned found = 0;
    for (unsigned k = 0; k < 12; ++k) found |= static_cast<unsigned>(values[k] == wanted) << k;
    return found;
#endif
}

/// Transposes: rows[i][j] <-> rows[j][i].
IMGMESH_INLINE void transpose8(Float8 (&rows)[8]) {
    Float8 a[8], b[8];
    for (int i = 0; i < 8; i += 2) {
        a[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        a[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (int i = 0; i < 8; i += 4)
        for (int k = 0; k < 2; ++k) {
            b[i + 2 * k] = __builtin_shufflevector(a[i + k], a[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
            b[i + 2 * k + 1] = __builtin_shufflevector(a[i + k], a[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    for (int i = 0; i < 4; ++i) {
        rows[i] = __builtin_shufflevector(b[i], b[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        rows[i + 4] = __builtin_shufflevector(b[i], b[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

}  // namespace imgmesh
