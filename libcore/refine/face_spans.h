// The pixels of a triangle as spans. The faces of a mesh divide its pixels among them: each counts once.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include "libcore/base/simd.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// The spans of a face of positive area, in ascending rows. Four rows are handled at once.
///
/// A pixel whose centre lies on an edge belongs to the face just to the right of its centre and, far less,
/// below; in the last column just to the left, in the last row just above. So each pixel of a mesh that
/// covers the whole width x height image is in exactly one face.
class FaceSpans {
  public:
    static constexpr int kBand = 32;

    IMGMESH_INLINE FaceSpans(const Vec2f& a, const Vec2f& b, const Vec2f& c, int width, int height)
        : width_(width) {
        const Vec2f *top = &a, *middle = &b, *bottom = &c;
        if (middle->y() < top->y()) std::swap(top, middle);
        if (bottom->y() < middle->y()) std::swap(middle, bottom);
        if (middle->y() < top->y()) std::swap(top, middle);
        const auto first_row = [height](float at) {
            int row = static_cast<int>(at);
            row += static_cast<float>(row) < at;
            row += static_cast<float>(row) == at && row == height - 1;
            return std::min(row, height);
        };
        next_row_ = first_row(top->y());
        middle_row_ = first_row(middle->y());
        end_row_ = first_row(bottom->y());
        full_ = Edge(*top, *bottom);
        upper_ = Edge(*top, *middle);
        lower_ = Edge(*middle, *bottom);
        middle_left_ = signed_area2(*top, *middle, *bottom) > 0;
    }

    /// Finds the spans of the next rows: (y() + k, begin(k)..end(k)-1) for 0 <= k < n. Those without a pixel
    /// have begin(k) >= end(k). Returns n, which is 0 at the end and kBand at most.
    IMGMESH_INLINE int next() {
        y_ = next_row_;
        const int rows = std::min(kBand, end_row_ - y_);
        if (rows <= 0) return 0;
        next_row_ += rows;
        std::int32_t *part_side = middle_left_ ? begin_ : end_, *full_side = middle_left_ ? end_ : begin_;
        const auto limit = static_cast<double>(width_), last = limit - 1;
        for (int k = 0; k < rows; k += 4) {
            const Double4 y = static_cast<double>(y_ + k) + Double4{0, 1, 2, 3};
            const auto below = y >= static_cast<double>(middle_row_);
            store(full_.first_pixel(y, last), full_side + k);
            const Double4 above = upper_.first_pixel(y, last);
            store(below ? lower_.first_pixel(y, last) : above, part_side + k);
        }
        return rows;
    }
    int y() const { return y_; }
    int begin(int k) const { return begin_[k]; }
    int end(int k) const { return end_[k]; }

  private:
    using Double4 = double __attribute__((vector_size(32)));
    using Int4 = std::int32_t __attribute__((vector_size(16)));

    // The first pixel of a row that is not left of an edge. It is exact: positions are multiples of 1/32 px,
    // so numerators stay below 2^53 and x is a multiple of 1 / denominator, which is at least 2^-26. Its
    // ceiling is the floor of what is more by 1 - 1 / (2 denominator), as long as x is wrong by less than
    // 1 / (2 denominator). The product with the inverse is wrong by 2^-36 at most.
    struct Edge {
        double numerator = 0, per_row = 0, inverse = 0;

        Edge() = default;
        IMGMESH_INLINE Edge(const Vec2f& top, const Vec2f& bottom) {
            const double px = double(top.x()) * 32, py = double(top.y()) * 32;
            const double dx = double(bottom.x()) * 32 - px, dy = double(bottom.y()) * 32 - py;
            numerator = px * dy - py * dx;
            per_row = 32 * dx;
            inverse = dy > 0 ? 1 / (32 * dy) : 0;
        }
        // Plus a part of a pixel, and not limited to the image.
        IMGMESH_INLINE Double4 first_pixel(const Double4& y, double last) const {
            const Double4 x = (numerator + y * per_row) * inverse;
            const double half = 0.5 * inverse;
            // The last column belongs to the face on its left.
            return x > last - half ? x + 2 : x + (1 - half);
        }
    };
    IMGMESH_INLINE void store(const Double4& first, std::int32_t* out) const {
        const double least = 0, most = width_;
        Double4 limited = first > least ? first : least + Double4{};
        limited = limited < most ? limited : most + Double4{};
        const Int4 pixel = __builtin_convertvector(limited, Int4);
        std::memcpy(out, &pixel, sizeof pixel);
    }

    int width_, next_row_, middle_row_, end_row_, y_ = 0;
    bool middle_left_;
    Edge full_, upper_, lower_;
    std::int32_t begin_[kBand], end_[kBand];
};

/// Calls row(y, begin, end) for the pixels (begin..end-1, y) of a face, as FaceSpans has them.
template <class Row>
IMGMESH_INLINE void for_each_span(const Vec2f& a, const Vec2f& b, const Vec2f& c, int width, int height,
                                  Row&& row) {
    FaceSpans spans(a, b, c, width, height);
    while (const int rows = spans.next())
        for (int k = 0; k < rows; ++k)
            if (spans.begin(k) < spans.end(k)) row(spans.y() + k, spans.begin(k), spans.end(k));
}

}  // namespace imgmesh
