#include "libcore/coding/pixel_weights.h"

#include <algorithm>
#include <cmath>

#include "libcore/base/index.h"

namespace imgmesh::coding {
namespace {

// The window is as large as that of SSIM.
constexpr int kRadius = 5;
// Far below this a variance of luma makes no difference [grey levels^2]. No pixel weighs more than nine times
// another, as no variance is above 127.5^2. In SSIM the weight is the inverse of the variance, and the
// constant 58.5; but that holds for small errors, and the meshes of few bytes have large ones where weights
// are small.
constexpr double kSmooth = 200;

// Means of the pixels at most `radius` rows and columns away, of those that the picture has.
std::vector<double> means_around(const std::vector<double>& values, int width, int height) {
    std::vector<double> in_row(values.size()), out(values.size());
    const auto at = [width](int x, int y) { return as_index(y) * as_index(width) + as_index(x); };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const int first = std::max(x - kRadius, 0), last = std::min(x + kRadius, width - 1);
            double sum = 0;
            for (int i = first; i <= last; ++i) sum += values[at(i, y)];
            in_row[at(x, y)] = sum / (last - first + 1);
        }
    for (int y = 0; y < height; ++y) {
        const int first = std::max(y - kRadius, 0), last = std::min(y + kRadius, height - 1);
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            for (int i = first; i <= last; ++i) sum += in_row[at(x, i)];
            out[at(x, y)] = sum / (last - first + 1);
        }
    }
    return out;
}

double mean_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
}

}  // namespace

std::vector<float> pixel_weights(const Bitmap& picture, std::span<const float> samples, Tune tune) {
    if (tune != Tune::kSsim || picture.width < 2 || picture.height < 2) return {};
    std::vector<double> luma, square;
    const auto channels = as_index(picture.channels);
    for (std::size_t i = 0; i < samples.size(); i += channels) {
        const float* p = &samples[i];
        luma.push_back(channels < 3 ? double{p[0]} : 0.299 * p[0] + 0.587 * p[1] + 0.114 * p[2]);
        square.push_back(luma.back() * luma.back());
    }
    const std::vector<double> mean = means_around(luma, picture.width, picture.height);
    std::vector<double> weight = means_around(square, picture.width, picture.height);
    for (std::size_t i = 0; i < weight.size(); ++i) {
        const double variance = std::max(weight[i] - mean[i] * mean[i], 0.0);
        weight[i] = 1 / std::sqrt(variance + kSmooth);
    }
    const double scale = 1 / mean_of(weight);
    std::vector<float> out;
    out.reserve(weight.size());
    for (const double w : weight) out.push_back(static_cast<float>(scale * w));
    return out;
}

}  // namespace imgmesh::coding
