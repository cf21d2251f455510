// Sixteen numbers of 16 bits side by side: looked through and changed at once.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include "libcore/base/simd.h"

namespace imgmesh {

using Short8 = std::int16_t __attribute__((vector_size(16)));
using Short16 = std::int16_t __attribute__((vector_size(32)));

// Not memcpy: of a place that is not known beforehand its checked form is a call.
struct [[gnu::packed, gnu::may_alias]] UnalignedShort16 {
    Short16 v;
};
IMGMESH_INLINE Short16 load16(const std::uint16_t* p) {
    return reinterpret_cast<const UnalignedShort16*>(p)->v;
}
IMGMESH_INLINE void store16(std::uint16_t* p, const Short16& v) {
    reinterpret_cast<UnalignedShort16*>(p)->v = v;
}

/// Returns a number whose bit k is set if lane k of a comparison holds.
IMGMESH_INLINE unsigned mask16(const Short16& holds) {
#if defined(__SSE2__)
    __m128i half[2];
    std::memcpy(half, &holds, sizeof half);
    return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(half[0], half[1])));
#elif defined(__wasm_simd128__)
    v128_t half[2];
    std::memcpy(half, &holds, sizeof half);
    return wasm_i8x16_bitmask(wasm_i8x16_narrow_i16x8(half[0], half[1]));
#else
    unsigned mask = 0;
    for (unsigned k = 0; k < 16; ++k) mask |= static_cast<unsigned>(holds[k] != 0) << k;
    return mask;
#endif
}

/// Returns a number whose bit k is set if values[k] is `wanted`, for 0 <= k < 16.
IMGMESH_INLINE unsigned match16(const std::uint16_t* values, std::uint16_t wanted) {
    return mask16(load16(values) == static_cast<std::int16_t>(wanted));
}
/// The same for either of two.
IMGMESH_INLINE unsigned match16(const std::uint16_t* values, std::uint16_t one, std::uint16_t other) {
    const Short16 v = load16(values);
    return mask16((v == static_cast<std::int16_t>(one)) | (v == static_cast<std::int16_t>(other)));
}

/// Returns the least of 16 numbers below 2^15.
IMGMESH_INLINE std::uint16_t least16(const std::uint16_t* values) {
#if defined(__SSE2__)
    const auto* eight = reinterpret_cast<const __m128i*>(values);
    __m128i v = _mm_min_epi16(_mm_loadu_si128(eight), _mm_loadu_si128(eight + 1));
    v = _mm_min_epi16(v, _mm_shuffle_epi32(v, 0x4e));
    v = _mm_min_epi16(v, _mm_shuffle_epi32(v, 0xb1));
    v = _mm_min_epi16(v, _mm_shufflelo_epi16(v, 0xb1));
    return static_cast<std::uint16_t>(_mm_cvtsi128_si32(v));
#elif defined(__wasm_simd128__)
    v128_t v = wasm_i16x8_min(wasm_v128_load(values), wasm_v128_load(values + 8));
    v = wasm_i16x8_min(v, wasm_i32x4_shuffle(v, v, 2, 3, 0, 1));
    v = wasm_i16x8_min(v, wasm_i32x4_shuffle(v, v, 1, 0, 3, 2));
    v = wasm_i16x8_min(v, wasm_i16x8_shuffle(v, v, 1, 0, 3, 2, 5, 4, 7, 6));
    return static_cast<std::uint16_t>(wasm_i16x8_extract_lane(v, 0));
#else
    return *std::min_element(values, values + 16);
#endif
}

/// Takes values[at] out: those behind it move up. The last one stays.
IMGMESH_INLINE void remove16(std::uint16_t* values, int at) {
    constexpr Short16 kPlace = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Short16 v = load16(values);
    const Short16 moved =
        __builtin_shufflevector(v, v, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 15);
    store16(values, kPlace < static_cast<std::int16_t>(at) ? v : moved);
}

/// Sets those from values[from] on.
IMGMESH_INLINE void fill16_from(std::uint16_t* values, int from, std::uint16_t value) {
    constexpr Short16 kPlace = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const Short16 filled = Short16{} + static_cast<std::int16_t>(value);
    store16(values, kPlace < static_cast<std::int16_t>(from) ? load16(values) : filled);
}

}  // namespace imgmesh
