#include "formats/compact/band_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libcore/base/index.h"
#include "libcore/base/simd.h"

namespace imgmesh::compact {
namespace {

// Of photographs on average, rounded; they sum to 1.
constexpr Taps kDefault = {208, -40, 160, -88, 48, -32, 0, 0, 0, 0};

// More pixels change the taps by less than they are rounded.
constexpr std::size_t kSample = 4096, kFewest = 256;
constexpr int kRounds = 2;

// The taps' neighbours, the pixel, and a 0 so that loops over rows are whole vectors.
using Row = std::array<double, kTaps + 2>;
using System = std::array<Row, kTaps>;

// Solves the symmetric system by elimination without pivots; what is added to the diagonal keeps it regular.
std::array<double, kTaps> solve(System& m) {
    for (std::size_t i = 0; i < kTaps; ++i)
        for (std::size_t r = 0; r < kTaps; ++r) {
            if (r == i) continue;
            const double factor = m[r][i] / m[i][i];
            for (std::size_t c = i; c <= kTaps; ++c) m[r][c] -= factor * m[i][c];
        }
    std::array<double, kTaps> solution{};
    for (std::size_t i = 0; i < kTaps; ++i) solution[i] = m[i][kTaps] / m[i][i];
    return solution;
}

using Double4 = double __attribute__((vector_size(32)));
IMGMESH_INLINE Double4 load4(const double* from) {
    Double4 v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}
IMGMESH_INLINE void store4(double* to, Double4 v) {
    __builtin_memcpy(to, &v, sizeof v);
}

// Adds the squares of the rows, weighted. A row of the system is summed over all of the sample while it is in
// registers.
IMGMESH_INLINE void add_squares(const std::vector<Row>& sample, const std::vector<double>& weight,
                                System& m) {
    static_assert(sizeof(Row) == 3 * sizeof(Double4));
    for (std::size_t i = 0; i < kTaps; ++i) {
        double* to = m.data()[i].data();
        Double4 a = load4(to), b = load4(to + 4), c = load4(to + 8);
        for (std::size_t s = 0; s < sample.size(); ++s) {
            const double* row = sample.data()[s].data();
            const double weighted = weight.data()[s] * row[i];
            a += weighted * load4(row);
            b += weighted * load4(row + 4);
            c += weighted * load4(row + 8);
        }
        store4(to, a);
        store4(to + 4, b);
        store4(to + 8, c);
    }
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void add_squares_avx2(const std::vector<Row>& sample,
                                                      const std::vector<double>& weight, System& m) {
    add_squares(sample, weight, m);
}
const bool kAvx2 = has_avx2();
#endif

void add_weighted(const std::vector<Row>& sample, const std::vector<double>& weight, System& m) {
#if defined(__x86_64__)
    if (kAvx2) return add_squares_avx2(sample, weight, m);
#endif
    add_squares(sample, weight, m);
}

}  // namespace

Taps fit_taps(std::span<const std::int16_t> values, int width, int height) {
    if (width < 8 || height < 8) return kDefault;
    const auto stride = static_cast<std::ptrdiff_t>(width);
    const std::array<std::ptrdiff_t, kTaps> offset = {
        -1,          -2,          -stride,    -stride - 1,     1 - stride,
        -2 * stride, -stride - 2, 2 - stride, -2 * stride - 1, 1 - 2 * stride};
    // An odd step, so that the sample is not some columns only.
    const std::size_t step = (values.size() / kSample) | 1;
    std::vector<Row> sample;
    sample.reserve(values.size() / step + 1);
    for (std::size_t i = 2 * as_index(width); i < values.size(); i += step) {
        const std::size_t x = i % as_index(width);
        if (x < 2 || x + 2 >= as_index(width)) continue;
        Row row{};
        for (std::size_t k = 0; k < kTaps; ++k) row[k] = values[i + static_cast<std::size_t>(offset[k])];
        row[kTaps] = values[i];
        sample.push_back(row);
    }
    if (sample.size() < kFewest) return kDefault;
    std::vector<double> weight(sample.size());
    std::array<double, kTaps> taps{};
    for (std::size_t k = 0; k < kTaps; ++k) taps[k] = kDefault[k] / 256.0;
    for (int round = 0; round < kRounds; ++round) {
        // Least squares, each pixel weighted by the reciprocal of its residual, come to least absolute ones.
        System m{};
        for (std::size_t i = 0; i < kTaps; ++i) {
            m[i][i] = 1;
            m[i][kTaps] = taps[i];
        }
        for (std::size_t s = 0; s < sample.size(); ++s) {
            double residual = sample[s][kTaps];
            for (std::size_t k = 0; k < kTaps; ++k) residual -= taps[k] * sample.data()[s].data()[k];
            weight[s] = 1 / (std::abs(residual) + 0.7);
        }
        add_weighted(sample, weight, m);
        taps = solve(m);
    }
    Taps rounded{};
    for (std::size_t k = 0; k < kTaps; ++k) {
        const double tap = std::round(taps[k] * (1 << kTapBits));
        if (!(std::abs(tap) <= kMaxTap)) return kDefault;
        rounded[k] = static_cast<std::int16_t>(tap);
    }
    return rounded;
}

}  // namespace imgmesh::compact
