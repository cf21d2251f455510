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

    float alpha(int x, int y) const { return alpha_ < 0 ? 1 : image_.pixel(x, y)[alpha_]; }
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
    std::int64_t seen = 0;  // pixels that are wholly transparent in not both
    double black = 0, white = 0, max_visible = 0, alpha = 0, max_alpha = 0;
};

// A pixel's colour as encoded in the common space, and its alpha, which is not below 0.
struct Covered {
    Vec3f rgb;
    float alpha;

    // L*u*v* over a grey ground. A pixel without alpha has no colour, whatever its numbers are.
    Vec3d over(float ground, ColorSpace common) const {
        const Vec3f base = Vec3f::Constant(ground);
        const Vec3f seen = alpha > 0 ? Vec3f(base + alpha * (rgb - base)) : base;
        return luv_from_linear(linear_from_encoded(common, seen)).cast<double>();
    }
};

// The squared distances over black and over white.
std::array<double, 2> visible_distances(const Covered& a, const Covered& b, ColorSpace common) {
    return {(a.over(0, common) - b.over(0, common)).squaredNorm(),
            (a.over(1, common) - b.over(1, common)).squaredNorm()};
}

void add_visible(const std::array<double, 2>& squares, RowSums& sums, float& visible) {
    sums.black += squares[0];
    sums.white += squares[1];
    const double distance = std::sqrt(std::max(squares[0], squares[1]));
    sums.max_visible = std::max(sums.max_visible, distance);
    visible = static_cast<float>(distance);
}

// Row y of both images: its sums, and its rows of the error images and the lumas, which are NaN before.
void compare_row(const Colors& a, const Colors& b, const GridSize& size, int y, RowSums& sums,
                 ImageDifference& result, std::vector<float>& luma_a, std::vector<float>& luma_b) {
    std::size_t i = size.row_begin(y);
    for (int x = 0; x < size.width; ++x, ++i) {
        const float alpha_a = a.alpha(x, y), alpha_b = b.alpha(x, y);
        const bool hidden_a = alpha_a <= 0, hidden_b = alpha_b <= 0;
        const double alpha = std::abs(double(alpha_a) - double(alpha_b));
        sums.alpha += alpha * alpha;
        sums.max_alpha = std::max(sums.max_alpha, alpha);
        sums.in_one_only += hidden_a != hidden_b;
        sums.seen += !(hidden_a && hidden_b);
        if (hidden_a && hidden_b) continue;
        const Vec3f encoded_a = a.encoded(x, y), encoded_b = b.encoded(x, y);
        const Vec3f linear_a = a.linear(encoded_a), linear_b = b.linear(encoded_b);
        const Vec3f rgb_a = a.common(encoded_a, linear_a), rgb_b = b.common(encoded_b, linear_b);
        const bool opaque = alpha_a == 1 && alpha_b == 1;
        if (!opaque)
            add_visible(visible_distances({rgb_a, std::max(alpha_a, 0.0f)}, {rgb_b, std::max(alpha_b, 0.0f)},
                                          result.color_space),
                        sums, result.visible[i]);
        if (hidden_a || hidden_b) continue;
        ++sums.pixels;
        const Vec3d rgb = rgb_a.cast<double>() - rgb_b.cast<double>();
        const Vec3d luv = luv_from_linear(linear_a).cast<double>() - luv_from_linear(linear_b).cast<double>();
        if (opaque) add_visible({luv.squaredNorm(), luv.squaredNorm()}, sums, result.visible[i]);
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
    result.luv = result.ciede2000 = result.visible = none;
    std::vector<float> luma_a = none, luma_b = none;
    // One sum for each row, added in order: the result is the same for any number of threads.
    std::vector<RowSums> rows(as_index(a.height));
    parallel_blocks(0, a.height, kGrainRows, [&](int first, int last) {
        for (int y = first; y < last; ++y)
            compare_row(colors_a, colors_b, a, y, rows[as_index(y)], result, luma_a, luma_b);
    });
    double sum_rgb = 0, sum_luv = 0, sum_black = 0, sum_white = 0, sum_alpha = 0;
    std::int64_t seen = 0;
    for (const RowSums& row : rows) {
        result.pixels += row.pixels;
        result.in_one_only += row.in_one_only;
        sum_rgb += row.rgb;
        sum_luv += row.luv;
        result.max_rgb = std::max(result.max_rgb, row.max_rgb);
        result.max_luv = std::max(result.max_luv, row.max_luv);
        seen += row.seen;
        sum_black += row.black;
        sum_white += row.white;
        sum_alpha += row.alpha;
        result.max_visible = std::max(result.max_visible, row.max_visible);
        result.max_alpha = std::max(result.max_alpha, row.max_alpha);
    }
    if (result.pixels > 0) {
        result.rms_rgb = std::sqrt(sum_rgb / double(3 * result.pixels));
        result.rms_luv = std::sqrt(sum_luv / double(result.pixels));
    } else {
        result.rms_rgb = result.max_rgb = result.rms_luv = result.max_luv =
            std::numeric_limits<double>::quiet_NaN();
    }
    if (seen > 0) result.rms_visible = std::sqrt(std::max(sum_black, sum_white) / double(seen));
    result.rms_alpha = std::sqrt(sum_alpha / double(std::max<std::size_t>(a.pixel_count(), 1)));
    result.psnr = -20 * std::log10(result.rms_rgb);
    result.ssim = mean_ssim(luma_a, luma_b, a.width, a.height);
    return result;
}

}  // namespace imgmesh
