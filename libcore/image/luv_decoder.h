// Converts encoded samples to L*u*v*, a row at a time: the first step of every build.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "libcore/image/color.h"

namespace imgmesh {

/// linear_from_encoded(), clipped, and then luv_from_linear() without roots and powers for samples of 8 bits.
/// Works in single precision: the result is at most 1e-4 away, or 1e-6 of its length where that is more.
/// Chroma of greys is exactly 0. The same bits on any processor.
class LuvDecoder {
  public:
    /// codes: samples are multiples of 1/255; others cost a power each.
    LuvDecoder(ColorSpace space, Range range, bool codes);

    /// Decodes `width` pixels of `stride` floats, whose R, G and B are at those places. Writes L*, u* and v*
    /// of each, interleaved. `planes` is memory for the work.
    void decode_row(const float* pixels, int stride, const std::array<int, 3>& rgb, int width,
                    std::vector<float>& planes, float* out) const;

  private:
    struct Lanes;

    ColorSpace space_;
    float low_, high_;                 ///< of linear values
    std::vector<float> code_, value_;  ///< encoded and linear values of the 256 codes; empty without
    /// From linear RGB: Y, X + 15 Y + 3 Z, and 4 X and 9 Y less white's part of that sum. The last two are of
    /// R - G and B - G.
    std::array<float, 3> y_, sum_;
    std::array<float, 2> u_, v_;
};

}  // namespace imgmesh
