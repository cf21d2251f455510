// What the rows above tell about a row of a band: for the decoder before any of its pixels is known, so it is
// computed for many pixels at a time. Internal to this room.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
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

/// A row and the two above it.
template <typename T>
struct ThreeRows {
    explicit ThreeRows(int width) : row(width), n(width), nn(width) {}
    void next() {
        std::swap(nn, n);
        std::swap(n, row);
    }
    PaddedRow<T> row, n, nn;
};

/// Some pixels of a row, of dx and of dy, where a loop over them finds all it needs at one place: what the
/// rows above give, and what the loop sets.
struct Chunk {
    static constexpr int kPixels = 256;
    template <typename T>
    using Pixels = std::array<T, kPixels + 8>;  // whole vectors

    std::array<Pixels<std::int32_t>, 2> prediction{};  ///< without W and WW; with kTapBits behind the point
    std::array<Pixels<std::uint16_t>, 2> energy{};     ///< without W and WW
    Pixels<std::int16_t> slope{};                      ///< of dy's residual to dx's

    std::array<Pixels<std::int16_t>, 2> value{};
    std::array<Pixels<std::int16_t>, 2> plain{};  ///< residuals, without the slope
    std::array<Pixels<std::uint16_t>, 2> size{};  ///< magnitudes of residuals
};

/// The rows of a band, as coding moves down: for each row next_row(), then begin_chunk() and end_chunk() of
/// all its chunks in turn.
class BandRows {
  public:
    /// `taps` of dx and dy.
    BandRows(int width, const std::array<Taps, 2>& taps);

    Chunk chunk;

    void next_row();
    bool first_row() const { return row_ == 0; }
    /// Returns the value left of the row.
    std::int16_t left(std::size_t component) const { return values_[component].row[-1]; }
    /// Sets what the rows above give to `count` pixels from column x on.
    void begin_chunk(int x, int count);
    /// Takes what was set for these pixels.
    void end_chunk(int x, int count);
    const std::int16_t* values(std::size_t component) const { return values_[component].row.get(); }

  private:
    int width_;
    int row_ = -1;
    std::array<Taps, 2> taps_;
    std::array<ThreeRows<std::int16_t>, 2> values_;
    std::array<ThreeRows<std::uint16_t>, 2> sizes_;
    ThreeRows<std::int16_t> xx_, xy_;  // products of residuals
};

}  // namespace imgmesh::compact
