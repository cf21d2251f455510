// Eight edges evaluated side by side; for quadrics of three channels one to a SIMD lane.
#pragma once

#include "libcore/collapse/quadric.h"

namespace imgmesh {

/// Up to eight pairs of quadrics. Give the pairs to set(), call evaluate(), read the results of
/// merged_minimum().
template <class Q>
class EdgeBatch {
  public:
    static constexpr int kWidth = 8;

    void set(int lane, const Q& i, const Q& j) { increment_[lane] = merged_minimum(i, j).increment; }
    void evaluate() {}
    float increment(int lane) const { return increment_[lane]; }

  private:
    float increment_[kWidth] = {};
};

/// The same, transposed.
template <>
class EdgeBatch<Quadric<3>> {
  public:
    static constexpr int kWidth = 8;

    void set(int lane, const Quadric<3>& i, const Quadric<3>& j) {
        transpose(i, i_, lane);
        transpose(j, j_, lane);
    }
    /// merged_minimum() of every pair set so far, bit for bit, on any processor; other lanes hold nothing of
    /// use.
    void evaluate();
    float increment(int lane) const { return increment_[lane]; }

  private:
    static constexpr int kFloats = sizeof(Quadric<3>) / sizeof(float);
    using Lanes = float[kFloats][kWidth];

    static void transpose(const Quadric<3>& q, Lanes& lanes, int lane) {
        const float* values = &q.px;
        for (int k = 0; k < kFloats; ++k) lanes[k][lane] = values[k];
    }
    static Quadric<3> column(const Lanes& lanes, int lane);
    void evaluate_lanes();
    void evaluate_avx2();

    alignas(64) Lanes i_ = {};
    alignas(64) Lanes j_ = {};
    alignas(64) float increment_[kWidth] = {};
};

}  // namespace imgmesh
