// One pixel of a band, the same for encoder and decoder: both know what is left of it and above. Internal to
// this room.
#pragma once

#include <algorithm>
#include <cstdint>

#include "formats/compact/band_rows.h"
#include "libcore/base/simd.h"

namespace imgmesh::compact {

/// A component of the row that is coded, in the hands of a loop over its pixels.
struct ComponentLane {
    std::int16_t* value = nullptr;
    std::uint8_t* size = nullptr;
    std::int8_t* small = nullptr;
    const std::int32_t* prediction = nullptr;
    const std::uint16_t* energy = nullptr;
    int tap_w = 0, tap_ww = 0;
    int w = 0, ww = 0, size_w = 0, size_ww = 0;

    /// The parts of the prediction and of the energy that the pixels on the left have are added here.
    IMGMESH_INLINE int predicted(int x) const { return prediction[x] + tap_w * w + tap_ww * ww; }
    IMGMESH_INLINE int energy_at(int x) const { return energy[x] + 4 * size_w + 2 * size_ww; }

    /// Notes the pixel's value. Displacements are numbers of 16 bits, and sums of them wrap.
    IMGMESH_INLINE void note(int x, int whole, int residual) {
        const auto stored = static_cast<std::int16_t>(whole + residual);
        value[x] = stored;
        ww = w;
        w = stored;
        size_ww = size_w;
        size_w = std::min(std::abs(residual), kMaxMagnitude);
        size[x] = static_cast<std::uint8_t>(size_w);
    }
    IMGMESH_INLINE void note_small(int x, int residual) {
        small[x] = static_cast<std::int8_t>(std::clamp(residual, -kMaxProduct, kMaxProduct));
    }
};

struct Lane {
    ComponentLane x, y;
    const std::int16_t* slope = nullptr;

    /// Of the row for which `rows.next()` was called last.
    Lane(BandRows& rows, const std::array<Taps, 2>& taps) : slope(rows.slope.get()) {
        begin(x, rows.x, rows.small_x, taps[0], rows.first_row());
        begin(y, rows.y, rows.small_y, taps[1], rows.first_row());
    }

  private:
    static void begin(ComponentLane& lane, ComponentRows& rows, PaddedRow<std::int8_t>& small,
                      const Taps& taps, bool first_row) {
        lane.value = rows.value.get();
        lane.size = rows.size.get();
        lane.small = small.get();
        lane.prediction = rows.prediction.get();
        lane.energy = rows.energy.get();
        // The first row is predicted by the pixel on the left alone.
        lane.tap_w = first_row ? 1 << kTapBits : taps[0];
        lane.tap_ww = first_row ? 0 : taps[1];
        lane.w = lane.ww = rows.value[-1];
    }
};

/// Codes pixel x. source.code(component, rest_class, energy, whole, negative, x) tells the residual of a
/// component, whose sign is turned where the prediction's rest is negative: the prediction is rounded to
/// `whole`, and what lies on the rest's side is likelier.
template <typename Source>
IMGMESH_INLINE void code_pixel(Lane& lane, int x, Source& source) {
    const int predicted_x = lane.x.predicted(x), energy_y = lane.y.energy_at(x);
    const Rounded rounded_x = rounded(predicted_x);
    const int residual_x = source.template code<0>(
        rounded_x.rest_class, std::min(lane.x.energy_at(x) + (energy_y >> 3), kMaxEnergy), rounded_x.whole,
        rounded_x.negative, x);
    lane.x.note(x, rounded_x.whole, residual_x);
    lane.x.note_small(x, residual_x);

    // dx's residual, with the rest, says by the slope of the rows above what dy's will be.
    const int plain_y = lane.y.predicted(x);
    const std::int64_t exact_x = std::int64_t{lane.x.w} * (1 << kTapBits) - predicted_x;
    const int predicted_y = plain_y + static_cast<int>((lane.slope[x] * exact_x) >> kSlopeBits);
    const Rounded rounded_y = rounded(predicted_y);
    const int residual_y =
        source.template code<1>(rounded_y.rest_class, std::min(energy_y + 2 * lane.x.size_w, kMaxEnergy),
                                rounded_y.whole, rounded_y.negative, x);
    lane.y.note(x, rounded_y.whole, residual_y);
    lane.y.note_small(x, lane.y.w - rounded(plain_y).whole);
}

}  // namespace imgmesh::compact
