// The weights of pixels side by side, four at a time.
#pragma once

#include "libcore/mesh/exact_face.h"

namespace imgmesh {

/// Up to kPixels pixels, each in a face that holds it. All numbers are whole and below 2^53, so doubles hold
/// them exactly.
class PixelRun {
  public:
    static constexpr int kPixels = 256;

    explicit PixelRun(WeightPrecision precision)
        : bits_(weight_bits(precision)), scale_(static_cast<double>(std::int64_t{4} << bits_)) {}

    /// The largest ExactFace::area.
    std::int64_t most_area() const { return (std::int64_t{1} << (53 - 2 - bits_)) - 1; }

    void put(int i, const ExactFace& face, const SideAreas& areas) {
        b_[i] = static_cast<double>(areas.b) * scale_ + face.precedence[1];
        c_[i] = static_cast<double>(areas.c) * scale_ + face.precedence[2];
        area_[i] = static_cast<double>(face.area) * 4;
    }

    /// Makes the weights of the first `count` pixels, those of ExactFace::weights(); of the others any.
    void divide(int count);
    float u(int i) const { return u_[i]; }
    float v(int i) const { return v_[i]; }

  private:
    struct Lanes;  // the same for several processors

    int bits_;
    double scale_;
    // The areas opposite b and c [units^2 / 4n] and the precedence of these corners, and the face's [units^2
    // / 4].
    double b_[kPixels] = {}, c_[kPixels] = {}, area_[kPixels] = {};
    float u_[kPixels], v_[kPixels];
};

}  // namespace imgmesh
