// Sixteen numbers of 16 bits side by side: looked through at once.
#pragma once

#include <algorithm>
#include <cstdint>

#include "libcore/base/simd.h"

namespace imgmesh {

/// Returns a number whose bit k is set if values[k] is `wanted`, for 0 <= k < 16.
IMGMESH_INLINE unsigned match16(const std::uint16_t* values, std::uint16_t wanted) {
#if defined(__SSE2__)
    const __m128i w = _mm_set1_epi16(static_cast<short>(wanted));
    const auto* eight = reinterpret_cast<const __m128i*>(values);
    return static_cast<unsigned>(_mm_movemask_epi8(_mm_packs_epi16(
        _mm_cmpeq_epi16(_mm_loadu_si128(eight), w), _mm_cmpeq_epi16(_mm_loadu_si128(eight + 1), w))));
#else
    unsigned found = 0;
    for (unsigned k = 0; k < 16; ++k) found |= static_cast<unsigned>(values[k] == wanted) << k;
    return found;
#endif
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
#else
    return *std::min_element(values, values + 16);
#endif
}

}  // namespace imgmesh
