// The weighted means and straight lines through the pixels around each pixel, eight pixels at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/segment/merge_heights.h"

namespace imgmesh {

/// Three values for each pixel of a grid, in planes with a margin on all sides.
class PaddedPlanes {
  public:
    static constexpr int kMargin = 8;  ///< pixels; at least the radius of windows, and eight for vectors

    PaddedPlanes() = default;
    PaddedPlanes(const GridSize& size, int planes)
        : stride_(as_index(size.width) + 2 * kMargin),
          plane_(stride_ * (as_index(size.height) + 2 * kMargin)),
          data_(plane_ * as_index(planes)) {}

    std::size_t stride() const { return stride_; }
    std::size_t index(int x, int y) const { return as_index(y + kMargin) * stride_ + as_index(x + kMargin); }
    float* plane(int p) { return data_.data() + as_index(p) * plane_; }
    const float* plane(int p) const { return data_.data() + as_index(p) * plane_; }

  private:
    std::size_t stride_ = 0, plane_ = 0;
    std::vector<float> data_;
};

/// Which pixels are smoothed together.
struct SmoothingWeights {
    double range;    ///< of the guide's values: half of the weight is gone at about 0.8 of it
    double height;   ///< the same of merges' heights; infinite if these make no difference
    double spatial;  ///< standard deviation [pixels], at most 4; windows reach twice as far
};

/// What the weights of all pixels are made of.
struct SmoothingScene {
    GridSize size;
    const PaddedPlanes& values;  ///< 4 planes: what is averaged, and each pixel's share, 0 in the margin
    const std::vector<std::int32_t>&
        places;  ///< of the pixels' cells in `heights`, in the layout of `values`
    const MergeHeights& heights;
};

/// Smooths each pixel of share > 0 with those around it; others keep their values. The weight of
/// another pixel falls with the distance, with the difference of the guide's values and with the height of
/// their cells' merge. It is exactly 0 beyond about 2.8 times either range. The result is the same for any
/// number of threads.
///
/// guide     3 planes
/// straight  fits a plane to the values, so that a ramp stays a ramp up to borders; else a mean
/// return    3 planes
PaddedPlanes smooth_planes(const SmoothingScene& scene, const PaddedPlanes& guide,
                           const SmoothingWeights& weights, bool straight);

}  // namespace imgmesh
