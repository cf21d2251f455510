// The sums of an edge, to be compiled into what needs many of them.
#pragma once

#include <cstring>

#include "libcore/base/index.h"
#include "libcore/optimize/row_sums.h"

namespace imgmesh::edge_sums {

using Double2 = double __attribute__((vector_size(16)));

inline constexpr std::size_t kEnergy = 11;  // where |I|^2 is, in twelve sums

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
        const double inverse = 1 / (kPlacesPerPixel * dy), slope = kPlacesPerPixel * dx * inverse;
        const double x = (top.x * dy + (kPlacesPerPixel * row - top.y) * dx) * inverse;
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

template <class Sums>
IMGMESH_INLINE void edge_of(const RowView& image, const Place& a, const Place& b, Moments& out) {
    const bool up = a.y > b.y;
    const Place &top = up ? b : a, &bottom = up ? a : b;
    const int lowest = kPlacesPerPixel * (image.height - 1), rightmost = kPlacesPerPixel * (image.width - 1);
    // The last row belongs to what lies above.
    const auto first_row = [&](int y) {
        return y == lowest ? image.height : (y + kPlacesPerPixel - 1) / kPlacesPerPixel;
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

IMGMESH_INLINE void edge_of(const RowView& image, const Place& a, const Place& b, Moments& out) {
    if (image.layout == SumLayout::kThree)
        edge_of<EdgeSums<false>>(image, a, b, out);
    else if (image.layout == SumLayout::kFour)
        edge_of<EdgeSums<true>>(image, a, b, out);
    else
        edge_of<WeightedEdgeSums>(image, a, b, out);
}

}  // namespace imgmesh::edge_sums
