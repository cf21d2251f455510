#include "libcore/coding/error_space.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/index.h"

namespace imgmesh::coding {
namespace {

// Squared weights of each channel's error, and of luma's, for Tune::kLuma.
constexpr double kPlain = 0.25, kLuma = 2.25;

// The symmetric square root of kPlain I + kLuma y y', where y are the weights of luma (Rec. 601).
void weigh_luma(std::span<float> rgb) {
    constexpr std::array<double, 3> y = {0.299, 0.587, 0.114};
    constexpr double yy = y[0] * y[0] + y[1] * y[1] + y[2] * y[2];
    const double luma = y[0] * rgb[0] + y[1] * rgb[1] + y[2] * rgb[2];
    const double plain = std::sqrt(kPlain), more = (std::sqrt(kPlain + kLuma * yy) - plain) / yy * luma;
    for (std::size_t k = 0; k < 3; ++k) rgb[k] = static_cast<float>(plain * rgb[k] + more * y[k]);
}

}  // namespace

std::vector<float> premultiplied(const Bitmap& picture) {
    std::vector<float> out(picture.data.begin(), picture.data.end());
    if (!picture.has_alpha()) return out;
    const auto channels = as_index(picture.channels);
    for (std::size_t i = 0; i < out.size(); i += channels)
        for (std::size_t k = 0; k + 1 < channels; ++k) out[i + k] *= out[i + channels - 1] / 255;
    return out;
}

ChannelGrid objective(const Bitmap& picture, const std::vector<float>& samples, Tune tune) {
    const auto channels = as_index(picture.channels);
    ChannelGrid grid(std::max(picture.width, 2), std::max(picture.height, 2), picture.channels, {});
    grid.data.reserve(grid.sample_count());
    for (int y = 0; y < grid.height; ++y)
        for (int x = 0; x < grid.width; ++x) {
            const std::size_t from = as_index(std::min(y, picture.height - 1)) * as_index(picture.width) +
                                     as_index(std::min(x, picture.width - 1));
            for (std::size_t k = 0; k < channels; ++k) grid.data.push_back(samples[from * channels + k]);
        }
    if (tune != Tune::kPsnr && channels >= 3)
        for (std::size_t i = 0; i < grid.pixel_count(); ++i)
            weigh_luma(std::span(grid.data).subspan(i * channels, 3));
    return grid;
}

ColorWeights color_weights(Tune tune, int channels) {
    ColorWeights weights;
    if (channels < 3) return weights;
    if (tune == Tune::kPsnr) {
        weights.shift = {0, -5, -5, 0};
    } else {
        weights.weight = {1, 0.25, 0.25, 1};
        weights.shift = {0, 12, 12, 0};
    }
    return weights;
}

}  // namespace imgmesh::coding
