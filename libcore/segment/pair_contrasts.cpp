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
static_assert(2 * kRadii[2] == kSquareReach);

// Sums over a square of pixels: the pixels inside the mask, their colours, and the squares of their colours.
constexpr int kSums = 7;
using Sums = std::array<float, kSums>;

struct Squares : Grid<Sums> {
    using Grid::Grid;

    const Sums& clamped(int x, int y) const {
        return at(std::clamp(x, 0, width - 1), std::clamp(y, 0, height - 1));
    }
};

// Sliding sums of 2 radius + 1 values each along a line of `count` values. They are doubles, so a value that
// leaves the sum cancels what it added, up to a negligible rounding.
void slide(Sums* first, std::ptrdiff_t step, int count, int radius, std::vector<Sums>& copy) {
    copy.resize(as_index(count));
    for (int i = 0; i < count; ++i) copy[as_index(i)] = first[i * step];
    std::array<double, kSums> sum{};
    for (int i = -radius; i < count; ++i) {
        if (i + radius < count)
            for (std::size_t k = 0; k < kSums; ++k) sum[k] += double(copy[as_index(i + radius)][k]);
        if (i - radius - 1 >= 0)
            for (std::size_t k = 0; k < kSums; ++k) sum[k] -= double(copy[as_index(i - radius - 1)][k]);
        if (i >= 0)
            for (std::size_t k = 0; k < kSums; ++k) first[i * step][k] = static_cast<float>(sum[k]);
    }
}

Squares square_sums(const FeatureImage& image, const Grid<Id>& cells, int radius) {
    Squares squares{cells};
    parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
        std::vector<Sums> copy;
        for (int y = begin; y < end; ++y) {
            for (int x = 0; x < cells.width; ++x) {
                if (cells.at(x, y) == kNone) continue;
                const float* c = image.pixel(x, y);
                squares.at(x, y) = {1, c[0], c[1], c[2], c[0] * c[0], c[1] * c[1], c[2] * c[2]};
            }
            slide(squares.row(y).data(), 1, cells.width, radius, copy);
        }
    });
    parallel_blocks(0, cells.width, kGrain, [&](int begin, int end) {
        std::vector<Sums> copy;
        for (int x = begin; x < end; ++x)
            slide(squares.values.data() + x, cells.width, cells.height, radius, copy);
    });
    return squares;
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

float sums_contrast(const float* a, const float* b) {
    Vec3d mean_a, mean_b, variance_a, variance_b;
    for (int c = 0; c < 3; ++c) {
        mean_a[c] = double(a[1 + c]) / double(a[0]);
        mean_b[c] = double(b[1 + c]) / double(b[0]);
        variance_a[c] = std::max(0.0, double(a[4 + c]) / double(a[0]) - mean_a[c] * mean_a[c]);
        variance_b[c] = std::max(0.0, double(b[4 + c]) / double(b[0]) - mean_b[c] * mean_b[c]);
    }
    return static_cast<float>(1 - std::exp(-population_distance(mean_a, variance_a, mean_b, variance_b)));
}

PairContrasts pair_contrasts(const FeatureImage& image, const Grid<Id>& cells) {
    PairContrasts contrasts{std::vector<float>(cells.size(), 0.0f), std::vector<float>(cells.size(), 0.0f)};
    const auto differs = [&](Id cell, int x, int y) {
        return cells.contains(x, y) && cells.at(x, y) != cell && cells.at(x, y) != kNone;
    };
    const float share = 1.0f / float(std::size(kRadii));
    for (const int radius : kRadii) {
        const Squares squares = square_sums(image, cells, radius);
        parallel_blocks(0, cells.height, kGrain, [&](int begin, int end) {
            for (int y = begin; y < end; ++y)
                for (int x = 0; x < cells.width; ++x) {
                    const std::size_t i = cells.index(x, y);
                    const Id cell = cells[i];
                    if (cell == kNone) continue;
                    if (differs(cell, x + 1, y))
                        contrasts.right[i] +=
                            share * sums_contrast(squares.clamped(x - radius, y).data(),
                                                  squares.clamped(x + 1 + radius, y).data());
                    if (differs(cell, x, y + 1))
                        contrasts.down[i] += share * sums_contrast(squares.clamped(x, y - radius).data(),
                                                                   squares.clamped(x, y + 1 + radius).data());
                }
        });
    }
    return contrasts;
}

}  // namespace imgmesh
