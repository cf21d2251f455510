#include "libcore/coding/row_sums.h"

#include <cmath>
#include <cstring>

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using Double2 = double __attribute__((vector_size(16)));

constexpr double kSampleUnit = 1.0 / 64;

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
        if (kFour) energy += sums[8];
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

// What an edge needs of the image.
struct Rows {
    const double* sums;
    int width, height;
    std::size_t stride;
};

template <bool kFour>
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
    constexpr std::size_t kStride = kFour ? 12 : 8;
    const std::size_t row = as_index(image.width + 1) * kStride;
    const double* sums = image.sums + as_index(begin) * row;
    EdgeSums<kFour> total;
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
    if (image.stride == 12)
        edge_of<true>(image, a, b, out);
    else
        edge_of<false>(image, a, b, out);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void edge_avx2(const Rows& image, const Place& a, const Place& b,
                                               Moments& out) {
    edge_of(image, a, b, out);
}
const bool kAvx2 = has_avx2();
#endif

}  // namespace

RowSums::RowSums(const ChannelGrid& image)
    : width_(image.width),
      height_(image.height),
      channels_(image.channels),
      stride_(image.channels == 4 ? 12 : 8) {
    if (channels_ < 1 || channels_ > 4 || width_ < 2 || height_ < 2)
        throw Error(ErrorKind::kBadArgument, cat("a picture to code has 1 to 4 channels and at least 2 x 2 "
                                                 "pixels, not ",
                                                 channels_, " and ", width_, " x ", height_));
    sums_.resize((as_index(height_) * as_index(width_ + 1) * stride_ + 7) / 8);
    const std::size_t energy = channels_ == 4 ? 8 : 3;
    double* out = sums_.data()->value;
    for (int y = 0; y < height_; ++y, out += stride_)
        for (int x = 0; x < width_; ++x, out += stride_) {
            std::memcpy(out + stride_, out, stride_ * sizeof(double));
            const float* pixel = image.pixel(x, y);
            for (std::size_t c = 0; c < as_index(channels_); ++c) {
                const double value = std::round(pixel[c] / kSampleUnit) * kSampleUnit;
                out[stride_ + c] += value;
                out[stride_ + 4 + c] += x * value;
                out[stride_ + energy] += value * value;
            }
        }
}

void RowSums::edge(const Place& a, const Place& b, Moments& out) const {
    const Rows rows{sums_.data()->value, width_, height_, stride_};
#if defined(__x86_64__)
    if (kAvx2) return edge_avx2(rows, a, b, out);
#endif
    edge_of(rows, a, b, out);
}

}  // namespace imgmesh
