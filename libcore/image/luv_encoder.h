// Converts L*u*v* to encoded samples, a row at a time: the last step of every drawing.
#pragma once

#include <span>
#include <vector>

#include "libcore/image/color.h"

namespace imgmesh {

/// The slow clear form, and the reference of the test: linear_from_luv(), clamped to [0, 1] unless `space` is
/// linear, then encoded_from_linear(), clamped again.
Vec3f encoded_from_luv(ColorSpace space, const Vec3f& luv);

/// encoded_from_luv() without roots and powers. Curves come from a table. Errors stay below 2/65535 (Rec709:
/// 2e-4 at the small jump of its curve near 0.018).
class LuvEncoder {
  public:
    explicit LuvEncoder(ColorSpace space);

    /// Encodes one row of `count` colours, given as planes: L, u and v have `count` values each, one after
    /// the other, at luv[0 .. 3 count). Writes R, G, B of colour i to out[i * stride .. i * stride + 2].
    void encode_row(std::span<const float> luv, int count, float* out, int stride) const;

  private:
    struct Block;
    struct Entry {
        float value, rise;  ///< to the next entry
    };

    float row_[3][3];           ///< of the matrix from XYZ to linear RGB of the space's own primaries
    std::vector<Entry> curve_;  ///< encoded value of (i / kCurveSteps)^2; empty for linear
};

}  // namespace imgmesh
