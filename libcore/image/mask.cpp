#include "libcore/image/mask.h"

#include <algorithm>

#include "libcore/base/error.h"

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

float least_visible_alpha(const Image& image) {
    constexpr float kSeen = 7.5f / 255;
    const int alpha = image.channel("A");
    if (alpha < 0) return kVisibleAlpha;
    // The length of the outline of the pixels from a threshold on, in sides of pixels.
    const auto outline = [&](float threshold) {
        const auto inside = [&](int x, int y) {
            return image.contains(x, y) && image.pixel(x, y)[alpha] >= threshold;
        };
        std::int64_t sides = 0;
        for (int y = 0; y <= image.height; ++y)
            for (int x = 0; x <= image.width; ++x) {
                const bool in = inside(x, y);
                sides += in != inside(x - 1, y);
                sides += in != inside(x, y - 1);
            }
        return sides;
    };
    const std::int64_t seen = outline(kSeen);
    return seen > 0 && 2 * outline(kVisibleAlpha) > 3 * seen ? kSeen : kVisibleAlpha;
}

bool has_soft_alpha(const Image& image) {
    constexpr float kLeast = 1.5f / 255, kMost = 253.5f / 255;
    constexpr double kShare = 0.001;
    const int alpha = image.channel("A");
    if (alpha < 0) return false;
    std::int64_t visible = 0, soft = 0, opaque = 0;
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const float a = image.pixel(i)[alpha];
        visible += a >= kVisibleAlpha;
        soft += a >= kLeast && a < kMost;
        opaque += a >= kMost;
    }
    return double(soft) > kShare * double(visible) || (visible > 0 && opaque == 0);
}

Mask in_both(const Mask& a, const Mask& b) {
    if (a.empty() || b.empty()) return a.empty() ? b : a;
    if (a.width != b.width || a.height != b.height)
        throw Error(ErrorKind::kBadFile,
                    cat("the mask is ", a.width, "x", a.height, ", the image is ", b.width, "x", b.height));
    Mask both = a;
    for (std::size_t i = 0; i < both.size(); ++i) both[i] = a[i] != 0 && b[i] != 0 ? 1 : 0;
    return both;
}

Image hidden_outside(const Image& image, const Mask& mask) {
    if (mask.empty()) return image;
    const int alpha = image.channel("A");
    Image out = image;
    if (alpha < 0) {
        ++out.channels;
        out.channel_names.emplace_back("A");
        out.data.clear();
        for (std::size_t i = 0; i < image.pixel_count(); ++i) {
            out.data.insert(out.data.end(), image.pixel(i), image.pixel(i) + image.channels);
            out.data.push_back(1);
        }
    }
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        if (!mask.contains(i)) out.pixel(i)[alpha < 0 ? image.channels : alpha] = 0;
    return out;
}

Mask image_mask(const Image& image, float threshold) {
    return thresholded(image, threshold, mask_value(image, threshold));
}

}  // namespace imgmesh
