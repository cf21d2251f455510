// What the rows above tell about a row of a band: for the decoder before any of its pixels is known, so it is
// computed for many pixels at a time. Internal to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/compact/residual_model.h"

namespace imgmesh::compact {

/// A row with room for neighbours beyond its ends, and for what vectors touch besides.
template <typename T>
class PaddedRow {
  public:
    static constexpr int kPad = 16;
    explicit PaddedRow(int width) : values_(static_cast<std::size_t>(width) + 2 * kPad) {}
    T* get() { return values_.data() + kPad; }
    const T* get() const { return values_.data() + kPad; }
    T& operator[](int x) { return get()[x]; }
    T operator[](int x) const { return get()[x]; }

  private:
    std::vector<T> values_;
};

/// One component, dx or dy: its values and the magnitudes of its residuals in a row and in the two above, and
/// what the rows above give.
struct ComponentRows {
    explicit ComponentRows(int width);

    PaddedRow<std::int16_t> value, value_n, value_nn;
    PaddedRow<std::int16_t> plain;  ///< residuals of the row, without the slope
    PaddedRow<std::uint8_t> size, size_n, size_nn;
    PaddedRow<std::int32_t> prediction;  ///< part of it, with kTapBits behind the point
    PaddedRow<std::uint16_t> energy;     ///< part of it
};

/// The rows of a band, as coding moves down.
class BandRows {
  public:
    /// `taps` of dx and dy.
    BandRows(int width, const std::array<Taps, 2>& taps);

    ComponentRows x, y;
    PaddedRow<std::int16_t> slope;  ///< of dy's residual to dx's

    /// Sets prediction, energy and slope of the next row, and its neighbours on the left. The row before must
    /// have its values, residuals and sizes.
    void next();
    bool first_row() const { return row_ == 0; }

  private:
    void next_component(ComponentRows& c, const Taps& taps);
    void next_slope();

    int width_;
    int row_ = -1;
    std::array<Taps, 2> taps_;
    PaddedRow<std::int16_t> xx_n_, xx_nn_, xy_n_, xy_nn_;  // products of residuals
};

}  // namespace imgmesh::compact
