#include "libcore/metrics/compare_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "libcore/base/error.h"
#include "libcore/base/parallel.h"
#include "libcore/image/color.h"
#include "libcore/metrics/ciede2000.h"
#include "libcore/metrics/ssim.h"

namespace imgmesh {
namespace {

constexpr int kGrainRows = 16;

// The colours of an image with any channels.
class Colors {
  public:
    Colors(const Image& image, ColorSpace common)
        : image_(image),
          common_(common),
          rgb_{image.channel("R"), image.channel("G"), image.channel("B")},
          alpha_(image.channel("A")) {
        if (std::min({rgb_[0], rgb_[1], rgb_[2]}) < 0) rgb_.fill(image.channel("Y"));
        if (rgb_[0] < 0)
            throw Error(ErrorKind::kUnsupported, "the image has no colour: neither channels R, G, B nor Y");
    }

    bool transparent(int x, int y) const { return alpha_ >= 0 && image_.pixel(x, y)[alpha_] <= 0; }
    Vec3f encoded(int x, int y) const {
        const float* p = image_.pixel(x, y);
        return {p[rgb_[0]], p[rgb_[1]], p[rgb_[2]]};
    }
    Vec3f linear(const Vec3f& encoded) const { return linear_from_encoded(image_.color_space, encoded); }
    /// In the space that both images are compared in.
    Vec3f common(const Vec3f& encoded, const Vec3f& linear) const {
        return image_.color_space == common_ ? encoded : encoded_from_linear(common_, linear);
    }

  private:
    const Image& image_;
    ColorSpace common_;
    std::array<int, 3> rgb_;
    int alpha_;
};

float luma(const Vec3f& rgb) {
    return 0.299f * rgb[0] + 0.587f * rgb[1] + 0.114f * rgb[2];  // ITU-R BT.601
}

struct RowSums {
    std::int64_t pixels = 0, in_one_only = 0;
    double rgb = 0, luv = 0, max_rgb = 0, max_luv = 0;
};

// Row y of both images: its sums, and its rows of the error images and the lumas, which are NaN before.
void compare_row(const Colors& a, const Colors& b, const GridSize& size, int y, RowSums& sums,
                 ImageDifference& result, std::vector<float>& luma_a, std::vector<float>& luma_b) {
    std::size_t i = size.row_begin(y);
    for (int x = 0; x < size.width; ++x, ++i) {
        const bool hidden_a = a.transparent(x, y), hidden_b = b.transparent(x, y);
        sums.in_one_only += hidden_a != hidden_b;
        if (hidden_a || hidden_b) continue;
        ++sums.pixels;
        const Vec3f encoded_a = a.encoded(x, y), encoded_b = b.encoded(x, y);
        const Vec3f linear_a = a.linear(encoded_a), linear_b = b.linear(encoded_b);
        const Vec3f rgb_a = a.common(encoded_a, linear_a), rgb_b = b.common(encoded_b, linear_b);
        const Vec3d rgb = rgb_a.cast<double>() - rgb_b.cast<double>();
        const Vec3d luv = luv_from_linear(linear_a).cast<double>() - luv_from_linear(linear_b).cast<double>();
        sums.rgb += rgb.squaredNorm();
        sums.luv += luv.squaredNorm();
        sums.max_rgb = std::max(sums.max_rgb, rgb.cwiseAbs().maxCoeff());
        sums.max_luv = std::max(sums.max_luv, luv.norm());
        result.luv[i] = static_cast<float>(luv.norm());
        result.ciede2000[i] =
            static_cast<float>(ciede2000(lab_from_linear(linear_a), lab_from_linear(linear_b)));
        luma_a[i] = luma(rgb_a);
        luma_b[i] = luma(rgb_b);
    }
}

}  // namespace

bool has_color(const Image& image) {
    return image.channel("Y") >= 0 ||
           std::min({image.channel("R"), image.channel("G"), image.channel("B")}) >= 0;
}

ImageDifference compare_images(const Image& a, const Image& b) {
    if (a.width != b.width || a.height != b.height)
        throw Error(ErrorKind::kBadArgument,
                    cat("images differ in size: ", a.width, "x", a.height, " and ", b.width, "x", b.height));
    ImageDifference result;
    // Differences of linear light are far from what one sees, and other tools do not report them.
    if (a.color_space == b.color_space && a.color_space != ColorSpace::kLinear)
        result.color_space = a.color_space;
    const Colors colors_a(a, result.color_space), colors_b(b, result.color_space);

    const std::vector<float> none(a.pixel_count(), std::numeric_limits<float>::quiet_NaN());
    result.luv = result.ciede2000 = none;
    std::vector<float> luma_a = none, luma_b = none;
    // One sum for each row, added in order: the result is the same for any number of threads.
    std::vector<RowSums> rows(as_index(a.height));
    parallel_blocks(0, a.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            compare_row(colors_a, colors_b, a, y, rows[as_index(y)], result, luma_a, luma_b);
    });
    double sum_rgb = 0, sum_luv = 0;
    for (const RowSums& row : rows) {
        result.pixels += row.pixels;
        result.in_one_only += row.in_one_only;
        sum_rgb += row.rgb;
        sum_luv += row.luv;
        result.max_rgb = std::max(result.max_rgb, row.max_rgb);
        result.max_luv = std::max(result.max_luv, row.max_luv);
    }
    if (result.pixels > 0) {
        result.rms_rgb = std::sqrt(sum_rgb / double(3 * result.pixels));
        result.rms_luv = std::sqrt(sum_luv / double(result.pixels));
    }
    result.psnr = -20 * std::log10(result.rms_rgb);
    result.ssim = mean_ssim(luma_a, luma_b, a.width, a.height);
    return result;
}

}  // namespace imgmesh
