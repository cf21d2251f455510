#include "formats/compact/band_rows.h"

#include <algorithm>

#include "libcore/base/simd.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace imgmesh::compact {
namespace {

// The taps of the rows above: N, NW, NE, NN, NWW, NEE, NNW, NNE.
std::array<const std::int16_t*, kTaps - 2> above(const std::int16_t* n, const std::int16_t* nn) {
    return {n, n - 1, n + 1, nn, n - 2, n + 2, nn - 1, nn + 1};
}

// Sums c[k] * from[k][x] over the eight taps.
void sum_taps(const std::array<const std::int16_t*, kTaps - 2>& from, const std::int16_t* c, int width,
              std::int32_t* sums) {
    int x = 0;
#if defined(__SSE2__)
    __m128i pair[4];
    for (int k = 0; k < 4; ++k)
        pair[k] = _mm_set1_epi32(static_cast<int>(static_cast<std::uint16_t>(c[2 * k]) |
                                                  static_cast<std::uint32_t>(c[2 * k + 1]) << 16));
    // The rows have room for whole vectors.
    for (; x < width; x += 8) {
        __m128i low{}, high{};
#pragma GCC unroll 4
        for (std::size_t k = 0; k < 4; ++k) {
            const __m128i a = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from[2 * k] + x)),
                          b = _mm_loadu_si128(reinterpret_cast<const __m128i*>(from[2 * k + 1] + x));
            low = _mm_add_epi32(low, _mm_madd_epi16(_mm_unpacklo_epi16(a, b), pair[k]));
            high = _mm_add_epi32(high, _mm_madd_epi16(_mm_unpackhi_epi16(a, b), pair[k]));
        }
        _mm_storeu_si128(reinterpret_cast<__m128i*>(sums + x), low);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(sums + x + 4), high);
    }
#endif
    for (; x < width; ++x) {
        std::int32_t sum = 0;
        for (std::size_t k = 0; k < from.size(); ++k) sum += c[k] * from[k][x];
        sums[x] = sum;
    }
}

using Short8 = std::int16_t __attribute__((vector_size(16)));
using UShort8 = std::uint16_t __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

template <typename V, typename T>
V load(const T* from) {
    V v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

// Eight residuals, clamped.
Short8 small(const std::int16_t* from) {
    constexpr Short8 kMost = Short8{} + static_cast<std::int16_t>(kMaxProduct);
    Short8 v = load<Short8>(from);
    v = v > kMost ? kMost : v;
    return v < -kMost ? -kMost : v;
}

// Four of eight numbers with their signs in 32 bits.
Int4 lower(Short8 v) {
    return reinterpret_cast<Int4>(__builtin_shufflevector(v, v, 0, 0, 1, 1, 2, 2, 3, 3)) >> 16;
}
Int4 upper(Short8 v) {
    return reinterpret_cast<Int4>(__builtin_shufflevector(v, v, 4, 4, 5, 5, 6, 6, 7, 7)) >> 16;
}

// The quotients' whole parts, with kSlopeBits behind the point. Exact: the numbers are below 2^24, so that a
// rounded quotient never reaches the next whole number.
Short8 quotients(Int4 numerator, Int4 denominator) {
    const Float4 q = __builtin_convertvector(numerator << kSlopeBits, Float4) /
                     __builtin_convertvector(denominator, Float4);
    Int4 whole = __builtin_convertvector(q, Int4);
    whole = whole > kMaxSlope ? Int4{} + kMaxSlope : whole;
    whole = whole < -kMaxSlope ? Int4{} - kMaxSlope : whole;
    return reinterpret_cast<Short8>(whole);
}

// A weighted sum of eight pixels' neighbours in the rows above, of magnitudes or of products.
template <typename LoadN, typename LoadNn>
IMGMESH_INLINE auto above_sum(const LoadN& n, const LoadNn& nn, int x) {
    return 4 * n(x) + 2 * (n(x - 1) + n(x + 1) + nn(x)) + n(x - 2) + n(x + 2) + nn(x - 1) + nn(x + 1);
}

}  // namespace

BandRows::BandRows(int width, const std::array<Taps, 2>& taps)
    : width_(width),
      taps_(taps),
      values_{ThreeRows<std::int16_t>(width), ThreeRows<std::int16_t>(width)},
      sizes_{ThreeRows<std::uint16_t>(width), ThreeRows<std::uint16_t>(width)},
      xx_(width),
      xy_(width) {}

void BandRows::next_row() {
    if (++row_ == 0) return;
    for (ThreeRows<std::int16_t>& values : values_) {
        for (int k = 0; k < 2; ++k) values.row[width_ + k] = values.row[width_ - 1];
        values.next();
        for (int k = 1; k <= 2; ++k) values.row[-k] = values.n[0];
    }
    for (ThreeRows<std::uint16_t>& sizes : sizes_) sizes.next();
    xx_.next();
    xy_.next();
}

void BandRows::begin_chunk(int x, int count) {
    if (row_ == 0) return;  // all is 0
    for (std::size_t component = 0; component < 2; ++component) {
        const ThreeRows<std::int16_t>& values = values_[component];
        sum_taps(above(values.n.get() + x, (row_ == 1 ? values.n : values.nn).get() + x),
                 taps_[component].data() + 2, count, chunk.prediction[component].data());
        const std::uint16_t *n = sizes_[component].n.get() + x, *nn = sizes_[component].nn.get() + x;
        for (int i = 0; i < count; i += 8) {
            const UShort8 sum = above_sum([&](int at) { return load<UShort8>(n + at); },
                                          [&](int at) { return load<UShort8>(nn + at); }, i);
            __builtin_memcpy(chunk.energy[component].data() + i, &sum, sizeof sum);
        }
    }
    const std::int16_t *xx_n = xx_.n.get() + x, *xx_nn = xx_.nn.get() + x, *xy_n = xy_.n.get() + x,
                       *xy_nn = xy_.nn.get() + x;
    for (int i = 0; i < count; i += 8) {
        const auto sum = [&](const std::int16_t* in_n, const std::int16_t* in_nn) {
            return above_sum([&](int at) { return load<Short8>(in_n + at); },
                             [&](int at) { return load<Short8>(in_nn + at); }, i);
        };
        const Short8 xx = sum(xx_n, xx_nn) + static_cast<std::int16_t>(kSlopeStart), xy = sum(xy_n, xy_nn),
                     slopes =
                         __builtin_shufflevector(quotients(lower(xy), lower(xx)),
                                                 quotients(upper(xy), upper(xx)), 0, 2, 4, 6, 8, 10, 12, 14);
        __builtin_memcpy(chunk.slope.data() + i, &slopes, sizeof slopes);
    }
}

void BandRows::end_chunk(int x, int count) {
    const auto pixels = static_cast<std::size_t>(count);
    for (std::size_t component = 0; component < 2; ++component) {
        std::copy_n(chunk.value[component].data(), pixels, values_[component].row.get() + x);
        std::copy_n(chunk.size[component].data(), pixels, sizes_[component].row.get() + x);
        // Beyond the row's end there are no residuals.
        std::fill_n(chunk.plain[component].data() + pixels, 8, std::int16_t{0});
    }
    for (int i = 0; i < count; i += 8) {
        const Short8 small_x = small(chunk.plain[0].data() + i), small_y = small(chunk.plain[1].data() + i),
                     xx = small_x * small_x, xy = small_x * small_y;
        __builtin_memcpy(xx_.row.get() + x + i, &xx, sizeof xx);
        __builtin_memcpy(xy_.row.get() + x + i, &xy, sizeof xy);
    }
}

}  // namespace imgmesh::compact
