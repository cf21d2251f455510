#include "libcore/segment/pair_contrasts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/parallel.h"

namespace imgmesh {
namespace {

constexpr int kGrain = 16;  // rows or columns a block

// Contours are sharp or soft, and texture has a size. Small squares locate a contour; large ones distinguish
// it from texture. No single size does as well (docs/decisions/0009-segmentation.md).
constexpr int kRadii[] = {2, 4, 8};

// Sums over a square of pixels: the pixels inside the mask, their colours, and the squares of their colours.
constexpr int kSums = 7;
using Sums = std::array<float, kSums>;

struct Squares {
    int width, height;
    std::vector<Sums> at;
    const Sums& clamped(int x, int y) const {
        return at[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    }
};

// Sliding sums of 2 radius + 1 values each along a line of `count` values. They are doubles, so a value that
// leaves the sum cancels what it added, up to a negligible rounding.
void slide(Sums* first, std::ptrdiff_t step, int count, int radius, std::vector<Sums>& copy) {
    copy.resize(static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) copy[static_cast<std::size_t>(i)] = first[i * step];
    std::array<double, kSums> sum{};
    for (int i = -radius; i < count; ++i) {
        if (i + radius < count)
            for (std::size_t k = 0; k < kSums; ++k)
                sum[k] += double(copy[static_cast<std::size_t>(i + radius)][k]);
        if (i - radius - 1 >= 0)
            for (std::size_t k = 0; k < kSums; ++k)
                sum[k] -= double(copy[static_cast<std::size_t>(i - radius - 1)][k]);
        if (i >= 0)
            for (std::size_t k = 0; k < kSums; ++k) first[i * step][k] = static_cast<float>(sum[k]);
    }
}

Squares square_sums(const FeatureImage& picture, const Cells& cells, int radius) {
    Squares squares{cells.width, cells.height, std::vector<Sums>(cells.of_pixel.size(), Sums{})};
    const auto width = static_cast<std::size_t>(cells.width);
    parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
        std::vector<Sums> copy;
        for (int y = begin; y < end; ++y) {
            Sums* row = squares.at.data() + static_cast<std::size_t>(y) * width;
            for (std::size_t x = 0; x < width; ++x) {
                const std::size_t i = static_cast<std::size_t>(y) * width + x;
                if (cells.of_pixel[i] == kNone) continue;
                const float* c = picture.pixel(i);
                row[x] = {1, c[0], c[1], c[2], c[0] * c[0], c[1] * c[1], c[2] * c[2]};
            }
            slide(row, 1, cells.width, radius, copy);
        }
    });
    parallel_blocks(0, cells.width, kGrain, [&](int begin, int end) {
        std::vector<Sums> copy;
        for (int x = begin; x < end; ++x)
            slide(squares.at.data() + x, cells.width, cells.height, radius, copy);
    });
    return squares;
}

float contrast(const Sums& a, const Sums& b) {
    Vec3d mean_a, mean_b, variance_a, variance_b;
    for (int c = 0; c < 3; ++c) {
        const auto k = static_cast<std::size_t>(c);
        mean_a[c] = double(a[1 + k]) / double(a[0]);
        mean_b[c] = double(b[1 + k]) / double(b[0]);
        variance_a[c] = std::max(0.0, double(a[4 + k]) / double(a[0]) - mean_a[c] * mean_a[c]);
        variance_b[c] = std::max(0.0, double(b[4 + k]) / double(b[0]) - mean_b[c] * mean_b[c]);
    }
    return static_cast<float>(1 - std::exp(-population_distance(mean_a, variance_a, mean_b, variance_b)));
}

}  // namespace

double population_distance(const Vec3d& mean_a, const Vec3d& variance_a, const Vec3d& mean_b,
                           const Vec3d& variance_b) {
    double sum = 0, ratio = 1;
    for (int c = 0; c < 3; ++c) {
        const double a = variance_a[c] + kUniformDeviation * kUniformDeviation,
                     b = variance_b[c] + kUniformDeviation * kUniformDeviation;
        const double step = mean_a[c] - mean_b[c];
        sum += step * step / (4 * (a + b));
        ratio *= (a + b) * (a + b) / (4 * a * b);
    }
    return sum + std::log(ratio) / 4;
}

double color_equivalent(double population_distance) {
    return kUniformDeviation * std::sqrt(8 * population_distance);
}

PairContrasts pair_contrasts(const FeatureImage& picture, const Cells& cells) {
    const auto width = static_cast<std::size_t>(cells.width);
    PairContrasts contrasts{std::vector<float>(cells.of_pixel.size(), 0.0f),
                            std::vector<float>(cells.of_pixel.size(), 0.0f)};
    const float share = 1.0f / float(std::size(kRadii));
    for (const int radius : kRadii) {
        const Squares squares = square_sums(picture, cells, radius);
        parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
            for (int y = begin; y < end; ++y)
                for (int x = 0; x < cells.width; ++x) {
                    const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
                    const Id cell = cells.of_pixel[i];
                    if (cell == kNone) continue;
                    if (x + 1 < cells.width && cells.of_pixel[i + 1] != cell &&
                        cells.of_pixel[i + 1] != kNone)
                        contrasts.right[i] += share * contrast(squares.clamped(x - radius, y),
                                                               squares.clamped(x + 1 + radius, y));
                    if (y + 1 < cells.height && cells.of_pixel[i + width] != cell &&
                        cells.of_pixel[i + width] != kNone)
                        contrasts.down[i] += share * contrast(squares.clamped(x, y - radius),
                                                              squares.clamped(x, y + 1 + radius));
                }
        });
    }
    return contrasts;
}

}  // namespace imgmesh
