#include "libcore/metrics/ssim.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "libcore/base/index.h"
#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// Weighted sums of a, b, a^2, b^2 and a b over a column or a window.
using Moments = std::array<double, 5>;

std::array<double, kSsimWindow> gaussian() {
    std::array<double, kSsimWindow> weights;
    double sum = 0;
    for (int i = 0; i < kSsimWindow; ++i) {
        const double x = (i - kSsimWindow / 2) / kSsimSigma;
        sum += weights[as_index(i)] = std::exp(-x * x / 2);
    }
    for (double& w : weights) w /= sum;
    return weights;
}

double ssim_of(const Moments& m) {
    const auto [mean_a, mean_b, aa, bb, ab] = m;
    const double variance_a = aa - mean_a * mean_a, variance_b = bb - mean_b * mean_b,
                 covariance = ab - mean_a * mean_b;
    return (2 * mean_a * mean_b + kSsimC1) * (2 * covariance + kSsimC2) /
           ((mean_a * mean_a + mean_b * mean_b + kSsimC1) * (variance_a + variance_b + kSsimC2));
}

}  // namespace

double mean_ssim(std::span<const float> a, std::span<const float> b, int width, int height) {
    const int rows = height - kSsimWindow + 1, columns = width - kSsimWindow + 1;
    if (rows <= 0 || columns <= 0) return std::numeric_limits<double>::quiet_NaN();
    const auto weights = gaussian();
    // One sum for each row, added in order: the result is the same for any number of threads.
    std::vector<double> sums(as_index(rows));
    std::vector<std::int64_t> counts(sums.size());
    parallel_blocks(0, rows, kGrainRows, [&](int first, int last) {
        const std::size_t w = as_index(width);
        std::vector<Moments> column(w);
        for (std::size_t y = as_index(first); y < as_index(last); ++y) {
            column.assign(w, Moments{});
            for (std::size_t k = 0; k < kSsimWindow; ++k)
                for (std::size_t x = 0; x < w; ++x) {
                    const double p = a[(y + k) * w + x], q = b[(y + k) * w + x];
                    const Moments sample = {p, q, p * p, q * q, p * q};
                    for (std::size_t m = 0; m < sample.size(); ++m) column[x][m] += weights[k] * sample[m];
                }
            for (std::size_t x = 0; x < as_index(columns); ++x) {
                Moments window{};
                for (std::size_t k = 0; k < kSsimWindow; ++k)
                    for (std::size_t m = 0; m < window.size(); ++m)
                        window[m] += weights[k] * column[x + k][m];
                const double ssim = ssim_of(window);
                if (std::isnan(ssim)) continue;
                sums[y] += ssim;
                ++counts[y];
            }
        }
    });
    double sum = 0;
    std::int64_t count = 0;
    for (std::size_t y = 0; y < sums.size(); ++y) {
        sum += sums[y];
        count += counts[y];
    }
    return count > 0 ? sum / double(count) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace imgmesh
