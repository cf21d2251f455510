#include "libcore/optimize/row_sums.h"

#include <cassert>
#include <cmath>
#include <cstring>

#include "libcore/base/error.h"
#include "libcore/optimize/edge_sums.h"

namespace imgmesh {
namespace {

constexpr double kSampleUnit = 1.0 / 64;

double rounded(double value, double unit) {
    return std::round(value / unit) * unit;
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void edge_avx2(const RowView& image, const Place& a, const Place& b,
                                               Moments& out) {
    edge_sums::edge_of(image, a, b, out);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

RowSums::RowSums(const ChannelGrid& image, std::span<const float> weights)
    : width_(image.width),
      height_(image.height),
      channels_(image.channels),
      layout_(!weights.empty()      ? SumLayout::kWeighted
              : image.channels == 4 ? SumLayout::kFour
                                    : SumLayout::kThree) {
    assert(weights.empty() || weights.size() == image.pixel_count());
    if (channels_ < 1 || channels_ > 4 || width_ < 2 || height_ < 2)
        throw Error(ErrorKind::kBadArgument, cat("a picture to code has 1 to 4 channels and at least 2 x 2 "
                                                 "pixels, not ",
                                                 channels_, " and ", width_, " x ", height_));
    const std::size_t stride = layout_ == SumLayout::kThree ? 8 : 12;
    sums_.resize((as_index(height_) * as_index(width_ + 1) * stride + 7) / 8);
    const std::size_t energy = layout_ == SumLayout::kThree ? 3 : edge_sums::kEnergy;
    double* out = sums_.data()->value;
    for (int y = 0; y < height_; ++y, out += stride)
        for (int x = 0; x < width_; ++x, out += stride) {
            std::memcpy(out + stride, out, stride * sizeof(double));
            const float* pixel = image.pixel(x, y);
            const double weight = weights.empty() ? 1 : rounded(weights[image.index(x, y)], kSampleUnit);
            if (!weights.empty()) {
                out[stride + 8] += weight;
                out[stride + 9] += x * weight;
                out[stride + 10] += x * (x * weight);
            }
            for (std::size_t c = 0; c < as_index(channels_); ++c) {
                const double value = rounded(pixel[c], kSampleUnit);
                // As exact as without weights; a constant error of the energy changes no choice.
                const double weighed = rounded(weight * value, kSampleUnit);
                out[stride + c] += weighed;
                out[stride + 4 + c] += x * weighed;
                out[stride + energy] += rounded(weight * value * value, kSampleUnit * kSampleUnit);
            }
        }
}

void RowSums::edge(const Place& a, const Place& b, Moments& out) const {
    const RowView rows = view();
#if defined(__x86_64__)
    if (kAvx2) return edge_avx2(rows, a, b, out);
#endif
    edge_sums::edge_of(rows, a, b, out);
}

}  // namespace imgmesh
