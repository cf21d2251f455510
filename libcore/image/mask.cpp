#include "libcore/image/mask.h"

#include <algorithm>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

template <typename Value>
Mask thresholded(const Image& image, float threshold, Value value) {
    Mask mask{image.width, image.height, {}};
    mask.values.reserve(image.pixel_count());
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        mask.values.push_back(value(image.pixel(i)) >= threshold);
    return mask;
}

}  // namespace

std::int64_t Mask::count() const {
    return std::count_if(begin(), end(), [](std::uint8_t in) { return in != 0; });
}

Mask alpha_mask(const Image& image, float threshold) {
    const int alpha = image.channel("A");
    if (alpha < 0) return {};
    Mask mask = thresholded(image, threshold, [&](const float* pixel) { return pixel[alpha]; });
    if (mask.count() == static_cast<std::int64_t>(image.pixel_count())) return {};
    return mask;
}

Mask image_mask(const Image& image, float threshold) {
    if (Mask mask = alpha_mask(image, threshold); !mask.empty()) return mask;
    const int grey = image.channel("Y");
    const int rgb[] = {image.channel("R"), image.channel("G"), image.channel("B")};
    if (grey >= 0) return thresholded(image, threshold, [&](const float* pixel) { return pixel[grey]; });
    if (std::min({rgb[0], rgb[1], rgb[2]}) >= 0)
        return thresholded(image, threshold, [&](const float* pixel) {
            return (pixel[rgb[0]] + pixel[rgb[1]] + pixel[rgb[2]]) / 3;
        });
    if (const int alpha = image.channel("A"); alpha >= 0)
        return thresholded(image, threshold, [&](const float* pixel) { return pixel[alpha]; });
    throw Error(ErrorKind::kUnsupported, "a mask needs channels A, Y, or R, G and B");
}

}  // namespace imgmesh
