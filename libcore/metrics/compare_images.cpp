#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/base/error.h"
#include "libcore/image/color.h"
#include "libcore/metrics/metrics.h"

namespace imgmesh {
namespace {

// Where R, G and B stand; all three the same for grey. luv_image() has refused pictures with neither.
std::array<int, 3> color_channels(const Image& image) {
    const std::array<int, 3> rgb = {image.channel("R"), image.channel("G"), image.channel("B")};
    if (std::min({rgb[0], rgb[1], rgb[2]}) >= 0) return rgb;
    const int grey = image.channel("Y");
    return {grey, grey, grey};
}

}  // namespace

ImageDifference compare_images(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw Error(ErrorCode::kUsage, cat("pictures differ in size: ", a.width, "x", a.height, " and ",
                                           b.width, "x", b.height));
    const FeatureImage luv_a = luv_image(a), luv_b = luv_image(b);
    const std::array<int, 3> channels_a = color_channels(a), channels_b = color_channels(b);
    ImageDifference result;
    double sum_rgb = 0, sum_luv = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            const float *pa = a.pixel(x, y), *pb = b.pixel(x, y), *la = luv_a.pixel(x, y),
                        *lb = luv_b.pixel(x, y);
            for (std::size_t c = 0; c < 3; ++c) {
                const double rgb = double(pa[channels_a[c]]) - pb[channels_b[c]], luv = double(la[c]) - lb[c];
                sum_rgb += rgb * rgb;
                sum_luv += luv * luv;
                result.max_rgb = std::max(result.max_rgb, std::abs(rgb));
            }
        }
    if (a.pixel_count() > 0) {
        result.rms_rgb = std::sqrt(sum_rgb / double(3 * a.pixel_count()));
        result.rms_luv = std::sqrt(sum_luv / double(a.pixel_count()));
    }
    result.psnr = -20 * std::log10(result.rms_rgb);
    return result;
}

}  // namespace imgmesh
