// Eight or sixteen floats side by side, in the compiler's own vector types: eight are two SSE registers, or
// one AVX2 register inside a function built for it; sixteen are one AVX-512 register. Arithmetic, comparison
// and selection (mask ? a : b) are operators of the language and work lane by lane.
#pragma once

#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace imgmesh {

using Float4 = float __attribute__((vector_size(16)));
using Float8 = float __attribute__((vector_size(32)));
using Int8 = std::int32_t __attribute__((vector_size(32)));
using Float16 = float __attribute__((vector_size(64)));  // sixteen of them, not half precision
using Int16 = std::int32_t __attribute__((vector_size(64)));

/// The number of lanes, and the integers of comparisons.
template <typename T>
inline constexpr int kLaneCount = static_cast<int>(sizeof(T) / sizeof(float));
template <typename T>
using LaneMask = decltype(T{} < T{});

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

IMGMESH_INLINE Float16 load16(const float* p) {
    Float16 v;
    std::memcpy(&v, p, sizeof v);
    return v;
}
/// Returns p[0], p[2], ... p[30]; reads p[31] too.
IMGMESH_INLINE Float16 load16_every_other(const float* p) {
    return __builtin_shufflevector(load16(p), load16(p + 16), 0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24,
                                   26, 28, 30);
}

/// Returns a number whose bit l is set if lane l of a comparison's result is true.
IMGMESH_INLINE unsigned bits_of(Int8 mask) {
    Int8 v = mask & Int8{1, 2, 4, 8, 16, 32, 64, 128};
    v |= __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
    v |= __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
    return static_cast<unsigned>(v[0] | v[1]);
}
IMGMESH_INLINE unsigned bits_of(Int16 mask) {
    const Int8 low = __builtin_shufflevector(mask, mask, 0, 1, 2, 3, 4, 5, 6, 7);
    const Int8 high = __builtin_shufflevector(mask, mask, 8, 9, 10, 11, 12, 13, 14, 15);
    return bits_of(low) | bits_of(high) << 8;
}

/// Says whether functions built for AVX2 may be called. This is decided in one place, so that a test program
/// can define its own and take the other path: results are the same bytes on both.
bool has_avx2();
/// The same for AVX-512: functions marked IMGMESH_AVX512.
bool has_avx512();
#define IMGMESH_AVX512 __attribute__((target("avx512f,avx512bw,avx512dq,avx512vl")))

/// Returns a number whose bit k is set if values[k] is `wanted`, for 0 <= k < 12.
inline unsigned match12(const std::uint32_t* values, std::uint32_t wanted) {
#if defined(__SSE2__)
    const __m128i w = _mm_set1_epi32(static_cast<int>(wanted));
    const auto four = [&](int k) {
        return _mm_cmpeq_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(values + k)), w);
    };
    const __m128i eight = _mm_packs_epi32(four(0), four(4)), last = _mm_packs_epi32(four(8), __m128i{});
    return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(eight, last)));
#elif defined(__wasm_simd128__)
    const v128_t w = wasm_i32x4_splat(static_cast<int>(wanted));
    const auto four = [&](int k) { return wasm_i32x4_eq(wasm_v128_load(values + k), w); };
    const v128_t eight = wasm_i16x8_narrow_i32x4(four(0), four(4)),
                 last = wasm_i16x8_narrow_i32x4(four(8), wasm_i32x4_splat(0));
    return wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(eight, last));
#else
    unsigned found = 0;
    for (unsigned k = 0; k < 12; ++k) found |= static_cast<unsigned>(values[k] == wanted) << k;
    return found;
#endif
}

}  // namespace imgmesh
