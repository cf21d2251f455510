#include "libcore/image/mask.h"

#include <algorithm>

#include "libcore/image/mask_value.h"

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
    return thresholded(image, threshold, mask_value(image, threshold));
}

}  // namespace imgmesh
