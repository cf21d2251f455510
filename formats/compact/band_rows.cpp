#include "formats/compact/band_rows.h"

#include <algorithm>
#include <utility>

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
using Byte8 = std::uint8_t __attribute__((vector_size(8)));
using Int4 = std::int32_t __attribute__((vector_size(16)));
using Float4 = float __attribute__((vector_size(16)));

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
template <typename Load>
auto above_sum(Load n, Load nn, int x) {
    return 4 * n(x) + 2 * (n(x - 1) + n(x + 1) + nn(x)) + n(x - 2) + n(x + 2) + nn(x - 1) + nn(x + 1);
}

}  // namespace

ComponentRows::ComponentRows(int width)
    : value(width),
      value_n(width),
      value_nn(width),
      plain(width),
      size(width),
      size_n(width),
      size_nn(width),
      prediction(width),
      energy(width) {}

BandRows::BandRows(int width, const std::array<Taps, 2>& taps)
    : x(width),
      y(width),
      slope(width),
      width_(width),
      taps_(taps),
      xx_n_(width),
      xx_nn_(width),
      xy_n_(width),
      xy_nn_(width) {}

void BandRows::next_component(ComponentRows& c, const Taps& taps) {
    if (row_ == 0) return;
    for (int k = 0; k < 2; ++k) c.value[width_ + k] = c.value[width_ - 1];
    std::swap(c.value_nn, c.value_n);
    std::swap(c.value_n, c.value);
    for (int k = 1; k <= 2; ++k) c.value[-k] = c.value_n[0];
    sum_taps(above(c.value_n.get(), (row_ == 1 ? c.value_n : c.value_nn).get()), taps.data() + 2, width_,
             c.prediction.get());
    std::swap(c.size_nn, c.size_n);
    std::swap(c.size_n, c.size);
    const auto widened = [](const PaddedRow<std::uint8_t>& row) {
        return
            [from = row.get()](int at) { return __builtin_convertvector(load<Byte8>(from + at), UShort8); };
    };
    for (int i = 0; i < width_; i += 8) {
        const UShort8 sum = above_sum(widened(c.size_n), widened(c.size_nn), i);
        __builtin_memcpy(c.energy.get() + i, &sum, sizeof sum);
    }
}

void BandRows::next_slope() {
    if (row_ == 0) return;
    std::swap(xx_nn_, xx_n_);
    std::swap(xy_nn_, xy_n_);
    for (int i = 0; i < width_; i += 8) {
        const Short8 small_x = small(x.plain.get() + i), small_y = small(y.plain.get() + i),
                     xx = small_x * small_x, xy = small_x * small_y;
        __builtin_memcpy(xx_n_.get() + i, &xx, sizeof xx);
        __builtin_memcpy(xy_n_.get() + i, &xy, sizeof xy);
    }
    const auto of = [](const PaddedRow<std::int16_t>& row) {
        return [from = row.get()](int at) { return load<Short8>(from + at); };
    };
    for (int i = 0; i < width_; i += 8) {
        const Short8 xx = above_sum(of(xx_n_), of(xx_nn_), i) + static_cast<std::int16_t>(kSlopeStart),
                     xy = above_sum(of(xy_n_), of(xy_nn_), i);
        const Short8 slopes = __builtin_shufflevector(
            quotients(lower(xy), lower(xx)), quotients(upper(xy), upper(xx)), 0, 2, 4, 6, 8, 10, 12, 14);
        __builtin_memcpy(slope.get() + i, &slopes, sizeof slopes);
    }
}

void BandRows::next() {
    ++row_;
    next_component(x, taps_[0]);
    next_component(y, taps_[1]);
    next_slope();
}

}  // namespace imgmesh::compact
