#include "libcore/coding/row_sums.h"

#include <cassert>
#include <cmath>
#include <cstring>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Double2 = double __attribute__((vector_size(16)));

constexpr double kSampleUnit = 1.0 / 64;
constexpr std::size_t kEnergy = 11;  // where |I|^2 is, in twelve sums

double rounded(double value, double unit) {
    return std::round(value / unit) * unit;
}

IMGMESH_INLINE Double4 load4(const double* p) {
    Double4 v;
    std::memcpy(&v, p, sizeof v);
    return v;
}

// The first pixel right of an edge, or on it, row after row, with 40 bits behind the point.
//
// The edge's x is a multiple of 1 / denominator in every row. So its ceiling is the floor of what is more by
// 1 - 1 / (2 denominator), and an error below 1 / (2 denominator) changes nothing: with sides below 2^16
// pixels it is 2^-21, and all rounding together less than 2^-23.
class FirstPixel {
  public:
    IMGMESH_INLINE FirstPixel(const Place& top, const Place& bottom, int row) {
        const auto dx = static_cast<double>(bottom.x - top.x), dy = static_cast<double>(bottom.y - top.y);
        const double inverse = 1 / (kQuarters * dy), slope = kQuarters * dx * inverse;
        const double x = (top.x * dy + (kQuarters * row - top.y) * dx) * inverse;
        at_ = static_cast<std::int64_t>((x + 1 - 0.5 * inverse) * kOne);
        step_ = static_cast<std::int64_t>(slope * kOne);
    }
    IMGMESH_INLINE std::int64_t next() {
        const std::int64_t pixel = at_ >> kBits;
        at_ += step_;
        return pixel;
    }

  private:
    static constexpr int kBits = 40;
    static constexpr double kOne = 0x1p40;
    std::int64_t at_, step_;
};

// Over the rows of an edge, with n pixels on its left. Each running total is added up again, and so weighs a
// row by how many follow, itself included: `later` and `later2`.
template <bool kFour>
struct EdgeSums {
    static constexpr std::size_t kStride = kFour ? 12 : 8;

    Double2 n = {}, n_later = {};  // n, n^2
    double n3 = 0, n_later2 = 0;   // n^3; n
    Double4 first = {}, first_later = {}, second = {};
    double energy = 0;

    IMGMESH_INLINE void add(const double* sums, std::int64_t left) {
        const auto count = static_cast<double>(left);
        const double square = count * count;
        n += Double2{count, square};
        n3 += square * count;
        n_later += n;
        n_later2 += n_later[0];
        first += load4(sums);
        first_later += first;
        second += load4(sums + 4);
        if (kFour) energy += sums[kEnergy];
    }
    // `end` is the row after the last one.
    IMGMESH_INLINE void finish(double sign, double end, Moments& out) {
        Double4 y_first = end * first - first_later;
        if (!kFour) {
            energy = first[3];
            first[3] = y_first[3] = 0;
        }
        // With r = end - y: sums of r are in `later`, those of r (r + 1) / 2 in `later2`.
        const Double2 yn = end * n - n_later;
        const double yyn = end * (yn[0] - n_later[0]) + (2 * n_later2 - n_later[0]);
        // 6 * (the sum of x^2 below n) is 2 n^3 - 3 n^2 + n, whole and exact.
        out.shape = sign * Double4{n[0], 0.5 * (n[1] - n[0]), (2 * n3 - 3 * n[1] + n[0]) / 6, energy};
        out.rows = sign * Double4{yn[0], 0.5 * (yn[1] - yn[0]), yyn, 0};
        out.i = sign * first;
        out.xi = sign * second;
        out.yi = sign * y_first;
    }
};

// The same for pixels with weights: nothing is known without the image.
struct WeightedEdgeSums {
    static constexpr std::size_t kStride = 12;

    Double4 first = {}, first_later = {}, second = {}, shape = {}, shape_later = {};
    double later2 = 0;

    IMGMESH_INLINE void add(const double* sums, std::int64_t) {
        first += load4(sums);
        first_later += first;
        second += load4(sums + 4);
        shape += load4(sums + 8);
        shape_later += shape;
        later2 += shape_later[0];
    }
    IMGMESH_INLINE void finish(double sign, double end, Moments& out) {
        const Double4 y_shape = end * shape - shape_later;
        const double yy = end * y_shape[0] + (2 * later2 - (end + 1) * shape_later[0]);
        out.shape = sign * shape;
        out.rows = sign * Double4{y_shape[0], y_shape[1], yy, 0};
        out.i = sign * first;
        out.xi = sign * second;
        out.yi = sign * (end * first - first_later);
    }
};

// What an edge needs of the image.
struct Rows {
    const double* sums;
    int width, height;
    SumLayout layout;
};

template <class Sums>
IMGMESH_INLINE void edge_of(const Rows& image, const Place& a, const Place& b, Moments& out) {
    const bool up = a.y > b.y;
    const Place &top = up ? b : a, &bottom = up ? a : b;
    const int lowest = kQuarters * (image.height - 1), rightmost = kQuarters * (image.width - 1);
    // The last row belongs to what lies above.
    const auto first_row = [&](int y) {
        return y == lowest ? image.height : (y + kQuarters - 1) / kQuarters;
    };
    const int begin = first_row(top.y), end = first_row(bottom.y);
    if (begin >= end) {
        out = {};
        return;
    }
    constexpr std::size_t kStride = Sums::kStride;
    const std::size_t row = as_index(image.width + 1) * kStride;
    const double* sums = image.sums + as_index(begin) * row;
    Sums total;
    if (top.x == rightmost && bottom.x == rightmost) {
        sums += row - kStride;
        for (int n = end - begin; n > 0; --n, sums += row) total.add(sums, image.width);
    } else {
        FirstPixel pixel(top, bottom, begin);
        for (int n = end - begin; n > 0; --n, sums += row) {
            const std::int64_t left = pixel.next();
            total.add(sums + static_cast<std::size_t>(left) * kStride, left);
        }
    }
    total.finish(up ? 1 : -1, end, out);
}

IMGMESH_INLINE void edge_of(const Rows& image, const Place& a, const Place& b, Moments& out) {
    if (image.layout == SumLayout::kThree)
        edge_of<EdgeSums<false>>(image, a, b, out);
    else if (image.layout == SumLayout::kFour)
        edge_of<EdgeSums<true>>(image, a, b, out);
    else
        edge_of<WeightedEdgeSums>(image, a, b, out);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void edge_avx2(const Rows& image, const Place& a, const Place& b,
                                               Moments& out) {
    edge_of(image, a, b, out);
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
    const std::size_t energy = layout_ == SumLayout::kThree ? 3 : kEnergy;
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
    const Rows rows{sums_.data()->value, width_, height_, layout_};
#if defined(__x86_64__)
    if (kAvx2) return edge_avx2(rows, a, b, out);
#endif
    edge_of(rows, a, b, out);
}

}  // namespace imgmesh
