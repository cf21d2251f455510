#include "formats/compact/band_fit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "libcore/base/index.h"

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
    for (std::size_t i = 2 * as_index(width); i < values.size(); i += step) {
        const std::size_t x = i % as_index(width);
        if (x < 2 || x + 2 >= as_index(width)) continue;
        Row row{};
        for (std::size_t k = 0; k < kTaps; ++k) row[k] = values[i + static_cast<std::size_t>(offset[k])];
        row[kTaps] = values[i];
        sample.push_back(row);
    }
    if (sample.size() < kFewest) return kDefault;
    std::array<double, kTaps> taps{};
    for (std::size_t k = 0; k < kTaps; ++k) taps[k] = kDefault[k] / 256.0;
    for (int round = 0; round < kRounds; ++round) {
        // Least squares, each pixel weighted by the reciprocal of its residual, come to least absolute ones.
        System m{};
        for (std::size_t i = 0; i < kTaps; ++i) {
            m[i][i] = 1;
            m[i][kTaps] = taps[i];
        }
        for (const Row& row : sample) {
            double residual = row[kTaps];
            for (std::size_t k = 0; k < kTaps; ++k) residual -= taps[k] * row[k];
            const double weight = 1 / (std::abs(residual) + 0.7);
            for (std::size_t i = 0; i < kTaps; ++i) {
                const double weighted = weight * row[i];
                double* sums = m.data()[i].data();
                for (std::size_t j = 0; j < row.size(); ++j) sums[j] += weighted * row.data()[j];
            }
        }
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
