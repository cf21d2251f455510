#include "libcore/metrics/error_image.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/parallel.h"
#include "libcore/image/color.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// Hues with rising lightness, each with as much chroma as sRGB allows there.
const std::array<Vec3f, 5> kScale = {Vec3f(0, 0, 0), Vec3f(25, 2, -70), Vec3f(50, 95, 0), Vec3f(75, 55, 65),
                                     Vec3f(100, 0, 0)};
const Vec3f kNoValue(50, -20, 20);

}  // namespace

Vec3f error_color(double share) {
    const double place = std::clamp(share, 0.0, 1.0) * double(kScale.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), kScale.size() - 2);
    const auto part = static_cast<float>(place - double(below));
    return (1 - part) * kScale[below] + part * kScale[below + 1];
}

Image error_image(std::span<const float> error, int width, int height, double range) {
    Image image = make_image(width, height, 3);
    parallel_blocks(0, height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            for (int x = 0; x < width; ++x) {
                const float value = error[image.index(x, y)];
                const Vec3f luv = std::isnan(value) ? kNoValue : error_color(value / range);
                const Vec3f rgb = encoded_from_linear(ColorSpace::kSrgb, linear_from_luv(luv));
                for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = std::clamp(rgb[c], 0.0f, 1.0f);
            }
    });
    return image;
}

}  // namespace imgmesh
