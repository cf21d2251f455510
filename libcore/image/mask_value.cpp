#include "libcore/image/mask_value.h"

#include <algorithm>

#include "libcore/base/error.h"
#include "libcore/image/mask.h"

namespace imgmesh {

std::function<float(const float*)> mask_value(const Image& image, float threshold) {
    const auto channel = [](int c) { return [c](const float* pixel) { return pixel[c]; }; };
    const int alpha = image.channel("A"), grey = image.channel("Y");
    const int r = image.channel("R"), g = image.channel("G"), b = image.channel("B");
    if (!alpha_mask(image, threshold).empty()) return channel(alpha);
    if (grey >= 0) return channel(grey);
    if (std::min({r, g, b}) >= 0)
        return [r, g, b](const float* pixel) { return (pixel[r] + pixel[g] + pixel[b]) / 3; };
    if (alpha >= 0) return channel(alpha);
    throw Error(ErrorKind::kUnsupported, "a mask needs channels A, Y, or R, G and B");
}

float largest_mask_value(const Image& image, float threshold) {
    const auto value = mask_value(image, threshold);
    float largest = value(image.pixel(0));
    for (std::size_t i = 1; i < image.pixel_count(); ++i) largest = std::max(largest, value(image.pixel(i)));
    return largest;
}

}  // namespace imgmesh
