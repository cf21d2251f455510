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

// The first pixel right of an edge, or on it, row after row. `rest` is what the edge lacks to that pixel's
// centre, as a negative numerator over `whole`.
struct FirstPixel {
    std::int64_t at, rest, step, step_rest, whole;

    FirstPixel(const Place& top, const Place& bottom, int row) {
        const std::int64_t dx = bottom.x - top.x, dy = bottom.y - top.y;
        whole = kQuarters * dy;
        const std::int64_t numerator = top.x * dy + (kQuarters * std::int64_t{row} - top.y) * dx;
        // Quotients of such integers are exact where they are whole, and else far enough from whole numbers.
        at = static_cast<std::int64_t>(static_cast<double>(numerator) / static_cast<double>(whole));
        rest = numerator - at * whole;
        if (rest > 0) next();
        step = static_cast<std::int64_t>(static_cast<double>(dx) / static_cast<double>(dy));
        step_rest = kQuarters * dx - step * whole;
        if (step_rest < 0) {
            --step;
            step_rest += whole;
        }
    }
    IMGMESH_INLINE void next() {
        ++at;
        rest -= whole;
    }
    IMGMESH_INLINE void advance() {
        at += step;
        rest += step_rest;
        const std::int64_t over = rest > 0 ? 1 : 0;
        at += over;
        rest -= over * whole;
    }
};

// Over the rows of an edge, with the number of pixels on its left.
template <bool kFour>
struct EdgeSums {
    Double2 powers = {}, y_powers = {}, mixed = {};  // n, n^2; the same times y; n^3, n y^2
    Double4 first = {}, second = {}, y_first = {};
    double energy = 0;

    IMGMESH_INLINE void add(const double* sums, double left, double y) {
        const Double2 power = {left, left * left};
        powers += power;
        y_powers += y * power;
        mixed += power[0] * Double2{power[1], y * y};
        const Double4 values = load4(sums);
        first += values;
        y_first += y * values;
        second += load4(sums + 4);
        if (kFour) energy += sums[8];
    }
    IMGMESH_INLINE void finish(double sign, Moments& out) {
        if (!kFour) {
            energy = first[3];
            first[3] = y_first[3] = 0;
        }
        const double n = powers[0], x = 0.5 * (powers[1] - n);
        // 6 * (the sum of x^2 below n) is 2 n^3 - 3 n^2 + n, whole and exact.
        out.shape = sign * Double4{n, x, (2 * mixed[0] - 3 * powers[1] + n) / 6, energy};
        out.rows = sign * Double4{y_powers[0], 0.5 * (y_powers[1] - y_powers[0]), mixed[1], 0};
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
    double y = begin;
    if (top.x == rightmost && bottom.x == rightmost) {
        sums += row - kStride;
        for (int n = end - begin; n > 0; --n, sums += row, y += 1) total.add(sums, image.width, y);
    } else {
        FirstPixel pixel(top, bottom, begin);
        for (int n = end - begin; n > 0; --n, sums += row, y += 1, pixel.advance())
            total.add(sums + static_cast<std::size_t>(pixel.at) * kStride, static_cast<double>(pixel.at), y);
    }
    total.finish(up ? 1 : -1, out);
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
    sums_.resize(as_index(height_) * as_index(width_ + 1) * stride_);
    const std::size_t energy = channels_ == 4 ? 8 : 3;
    double* out = sums_.data();
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
    const Rows rows{sums_.data(), width_, height_, stride_};
#if defined(__x86_64__)
    if (kAvx2) return edge_avx2(rows, a, b, out);
#endif
    edge_of(rows, a, b, out);
}

}  // namespace imgmesh
