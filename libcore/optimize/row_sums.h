// Sums of an image over any triangle, at the cost of its rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/base/simd.h"
#include "libcore/optimize/place.h"

namespace imgmesh {

using Double4 = double __attribute__((vector_size(32), aligned(32)));

/// Sums over pixels (x, y) with the values I of up to four channels, one a lane. Each term counts as much as
/// its pixel weighs.
struct Moments {
    Double4 shape = {};  ///< 1, x, x^2, |I|^2
    Double4 rows = {};   ///< y, x y, y^2, 0
    Double4 i = {};      ///< I
    Double4 xi = {};     ///< x I
    Double4 yi = {};     ///< y I
};

IMGMESH_INLINE void add(Moments& to, const Moments& m) {
    to.shape += m.shape;
    to.rows += m.rows;
    to.i += m.i;
    to.xi += m.xi;
    to.yi += m.yi;
}
IMGMESH_INLINE void subtract(Moments& from, const Moments& m) {
    from.shape -= m.shape;
    from.rows -= m.rows;
    from.i -= m.i;
    from.xi -= m.xi;
    from.yi -= m.yi;
}

/// What RowSums has of each pixel.
enum class SumLayout {
    kThree,    ///< I of three channels and |I|^2, x I
    kFour,     ///< I, x I, three unused, |I|^2
    kWeighted  ///< times the weight w: I, x I, 1, x, x^2, |I|^2
};

/// What an edge needs of the sums.
struct RowView {
    const double* sums;
    int width, height;
    SumLayout layout;
};

/// Of every row the sums over its first pixels: of I, x I and |I|^2. An edge's moments are the sums over all
/// pixels left of it, in its rows; those of a polygon are the sum over its edges (Green's theorem).
///
/// Samples are rounded to 1/64, so that sums are exact and do not depend on their order: below 10 megapixels
/// of values up to 255. Takes 64 bytes a pixel, 96 for four channels or with weights.
class RowSums {
  public:
    /// Throws Error(kBadArgument) unless the image has 1 to 4 channels and at least 2 x 2 pixels.
    /// weights  of the pixels, with a mean of 1, rounded to 1/64; none: all are 1, and edges take less time
    explicit RowSums(const ChannelGrid& image, std::span<const float> weights = {});

    int width() const { return width_; }
    int height() const { return height_; }
    int channels() const { return channels_; }
    RowView view() const { return {sums_.data()->value, width_, height_, layout_}; }

    /// Returns the moments of the edge from a to b: added up around a polygon, counter-clockwise on screen,
    /// they are the moments of its pixels. So that of b to a is the negative. A pixel centre on an edge
    /// belongs to the polygon on its right, or below; at the right and lower side of the image to the inner
    /// one. Source: as libcore/refine/face_spans.h, in integers.
    void edge(const Place& a, const Place& b, Moments& out) const;

  private:
    // So a place of three channels is one line of a cache.
    struct alignas(64) Line {
        double value[8] = {};
    };
    int width_, height_, channels_;
    SumLayout layout_;
    std::vector<Line> sums_;  // (width + 1) pixels for each row
};

}  // namespace imgmesh
