// Filters for textons. A Gaussian that is long in one direction is a round one, smoothed along a line, and
// derivatives of round ones turn by combining a few: so eight directions cost little more than one.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libcore/base/parallel.h"
#include "libcore/segment/contours/codes.h"

namespace imgmesh {
namespace {

constexpr int kDirections = 8;
constexpr double kSigma = 2;   // across a filter [pixels]
constexpr double kLength = 3;  // of a filter, in widths
constexpr int kReach = 6;      // of the round kernels: 3 sigma

using Kernel = std::array<float, 2 * kReach + 1>;

// Index of a pixel in a line of `size` that continues as its own mirror image.
int mirrored(int i, int size) {
    const int period = 2 * size, k = ((i % period) + period) % period;
    return k < size ? k : period - 1 - k;
}

// A derivative (0, 1 or 2) of a Gaussian: no mean except for the Gaussian itself, absolute values sum to 1.
Kernel gaussian(int derivative, double sigma) {
    Kernel kernel;
    std::array<double, std::tuple_size_v<Kernel>> values;
    double mean = 0, norm = 0;
    for (int i = -kReach; i <= kReach; ++i) {
        const double t = i / sigma, e = std::exp(-t * t / 2);
        values[as_index(i + kReach)] = derivative == 0 ? e : derivative == 1 ? t * e : (t * t - 1) * e;
    }
    if (derivative > 0)
        for (const double v : values) mean += v / double(values.size());
    for (double& v : values) norm += std::abs(v -= mean);
    for (std::size_t i = 0; i < values.size(); ++i) kernel[i] = static_cast<float>(values[i] / norm);
    return kernel;
}

// A row of pixels, for sums that compilers turn into vector code. Each pixel has a sum of its own.
auto row_of(float* first, const GridSize& size) {
    return Eigen::Map<Eigen::ArrayXf>(first, size.width);
}
auto row_of(const float* first, const GridSize& size) {
    return Eigen::Map<const Eigen::ArrayXf>(first, size.width);
}

Plane along_rows(const Plane& plane, const GridSize& size, const Kernel& kernel) {
    Plane result(plane.size());
    std::vector<float> row(as_index(size.width + 2 * kReach));
    for (int y = 0; y < size.height; ++y) {
        for (int x = -kReach; x < size.width + kReach; ++x)
            row[as_index(x + kReach)] = plane[size.index(mirrored(x, size.width), y)];
        float* out = result.data() + size.row_begin(y);
        for (std::size_t k = 0; k < kernel.size(); ++k)
            row_of(out, size) += kernel[k] * row_of(row.data() + k, size);
    }
    return result;
}

Plane along_columns(const Plane& plane, const GridSize& size, const Kernel& kernel) {
    Plane result(plane.size());
    for (int y = 0; y < size.height; ++y) {
        float* out = result.data() + size.row_begin(y);
        for (std::size_t k = 0; k < kernel.size(); ++k) {
            const float* row = plane.data() + size.row_begin(mirrored(y + as_int(k) - kReach, size.height));
            row_of(out, size) += kernel[k] * row_of(row, size);
        }
    }
    return result;
}

// One step along a line: between two pixels, of which the second may have no weight.
struct LineStep {
    int dx, dy, next_dx, next_dy;
    float weight, next_weight;
};

// A Gaussian along the direction of `angle`, in steps of one pixel along the axis that is closer to it.
std::vector<LineStep> line_kernel(double angle, double sigma) {
    const double c = std::cos(angle), s = std::sin(angle);
    const bool flat = std::abs(c) > std::abs(s) - 1e-9;
    const double slope = flat ? s / c : c / s, step = 1 / std::max(std::abs(c), std::abs(s));
    const int reach = static_cast<int>(std::ceil(2.5 * sigma / step));
    std::vector<LineStep> steps;
    double norm = 0;
    for (int i = -reach; i <= reach; ++i) norm += std::exp(-std::pow(i * step / sigma, 2) / 2);
    for (int i = -reach; i <= reach; ++i) {
        const double weight = std::exp(-std::pow(i * step / sigma, 2) / 2) / norm, side = i * slope;
        const int low = static_cast<int>(std::floor(side + 1e-9));
        const double share = std::max(0.0, side - low);
        const auto first = static_cast<float>(weight * (1 - share)),
                   second = static_cast<float>(weight * share);
        steps.push_back(flat ? LineStep{i, low, i, low + 1, first, second}
                             : LineStep{low, i, low + 1, i, first, second});
    }
    return steps;
}

Plane along_line(const Plane& plane, const GridSize& size, const std::vector<LineStep>& steps) {
    int margin = 0;
    for (const LineStep& s : steps)
        margin = std::max({margin, std::abs(s.dx), std::abs(s.dy), std::abs(s.next_dx), std::abs(s.next_dy)});
    const GridSize outer{size.width + 2 * margin, size.height + 2 * margin};
    Plane padded(outer.pixel_count());
    for (int y = 0; y < outer.height; ++y) {
        const std::size_t from = size.row_begin(mirrored(y - margin, size.height)), to = outer.row_begin(y);
        for (int x = 0; x < outer.width; ++x)
            padded[to + as_index(x)] = plane[from + as_index(mirrored(x - margin, size.width))];
    }
    Plane result(plane.size());
    for (int y = 0; y < size.height; ++y) {
        float* out = result.data() + size.row_begin(y);
        for (const LineStep& s : steps) {
            const float* a = padded.data() + outer.index(margin + s.dx, y + margin + s.dy);
            const float* b = padded.data() + outer.index(margin + s.next_dx, y + margin + s.next_dy);
            row_of(out, size) += s.weight * row_of(a, size) + s.next_weight * row_of(b, size);
        }
    }
    return result;
}

// Derivatives of the lightness at the filters' width.
struct Derivatives {
    Plane x, y, xx, xy, yy;
};

Derivatives derivatives(const Plane& lightness, const GridSize& size) {
    const Kernel g0 = gaussian(0, kSigma), g1 = gaussian(1, kSigma), g2 = gaussian(2, kSigma);
    const Plane plain = along_rows(lightness, size, g0), first = along_rows(lightness, size, g1);
    return {along_columns(first, size, g0), along_columns(plain, size, g1),
            along_columns(along_rows(lightness, size, g2), size, g0), along_columns(first, size, g1),
            along_columns(plain, size, g2)};
}

// What gxy must be multiplied by to have the scale of gxx: their kernels are divided by different sums.
float mixed_scale() {
    double first = 0, second = 0, plain = 0;
    for (int i = -kReach; i <= kReach; ++i) {
        const double t = i / kSigma, e = std::exp(-t * t / 2);
        plain += e;
        first += std::abs(t * e);
        second += std::abs((t * t - 1) * e);
    }
    return static_cast<float>(first * first / (second * plain));
}

// The even and the odd filter whose long side has the direction of `angle`.
std::pair<Plane, Plane> oriented(const Derivatives& d, const GridSize& size, double angle) {
    const auto c = static_cast<float>(std::cos(angle)), s = static_cast<float>(std::sin(angle));
    const float mixed = -2 * s * c * mixed_scale();
    Plane even(d.x.size()), odd(d.x.size());
    for (std::size_t i = 0; i < even.size(); ++i) {
        even[i] = s * s * d.xx[i] + mixed * d.xy[i] + c * c * d.yy[i];
        odd[i] = c * d.y[i] - s * d.x[i];
    }
    const std::vector<LineStep> line = line_kernel(angle, kSigma * std::sqrt(kLength * kLength - 1));
    return {along_line(even, size, line), along_line(odd, size, line)};
}

// A bright spot of the filters' width in darker surroundings.
Plane spots(const Plane& lightness, const GridSize& size) {
    const double inner = kSigma / std::numbers::sqrt2, outer = 2 * inner;
    const auto blurred = [&](double sigma) {
        const Kernel kernel = gaussian(0, sigma);
        return along_columns(along_rows(lightness, size, kernel), size, kernel);
    };
    // The integral of |difference| of Gaussians with variances 1 : 4: they are equal at radius r with
    // r^2 = ln 4 * 8/3 (in units of the inner variance).
    const double r2 = std::log(4.0) * 8 / 3, norm = 2 * (std::exp(-r2 / 8) - std::exp(-r2 / 2));
    Plane result = blurred(inner);
    const Plane wide = blurred(outer);
    for (std::size_t i = 0; i < result.size(); ++i)
        result[i] = (result[i] - wide[i]) / static_cast<float>(norm);
    return result;
}

}  // namespace

Codes textons(const SmallImage& image) {
    const GridSize& size = image.inside;
    Plane lightness(size.pixel_count());
    for (std::size_t i = 0; i < lightness.size(); ++i) lightness[i] = image.luv.pixel(i)[0] / 100;
    const Derivatives d = derivatives(lightness, size);
    std::vector<Plane> planes(2 * kDirections + 1);
    parallel_blocks(0, kDirections + 1, 1, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            const std::size_t at = 2 * as_index(k);
            if (k == kDirections)
                planes[at] = spots(lightness, size);
            else
                std::tie(planes[at], planes[at + 1]) = oriented(d, size, std::numbers::pi * k / kDirections);
        }
    });
    for (Plane& plane : planes)
        for (float& value : plane) value = rounded(value, kColorStep / 100);
    return cluster(planes, image.inside);
}

}  // namespace imgmesh
