// One pixel of a band, the same for encoder and decoder: both know what is left of it and above. Internal to
// this room.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "formats/compact/band_rows.h"
#include "libcore/base/simd.h"

namespace imgmesh::compact {

/// The contexts' classes by the rest of the prediction, for a loop; times kEnergies.
inline constexpr auto kClassOffset = [] {
    std::array<std::uint16_t, 1 << kTapBits> offsets{};
    for (int rest = 0; rest < 1 << kTapBits; ++rest)
        offsets[static_cast<std::size_t>(rest)] = static_cast<std::uint16_t>(class_of(rest) * kEnergies);
    return offsets;
}();
IMGMESH_INLINE int place_of(int prediction, int energy) {
    return kClassOffset.data()[prediction & ((1 << kTapBits) - 1)] + energy;
}

/// A component of the row that is coded, in the hands of a loop over its pixels.
struct ComponentLane {
    std::int16_t* value = nullptr;
    std::int16_t* plain = nullptr;
    std::uint8_t* size = nullptr;
    const std::int32_t* prediction = nullptr;
    const std::uint16_t* energy = nullptr;
    int tap_w = 0, tap_ww = 0;
    int w = 0, ww = 0, size_w = 0, size_ww = 0;

    /// The parts of the prediction and of the energy that the pixels on the left have are added here.
    IMGMESH_INLINE int predicted(int x) const { return prediction[x] + tap_w * w + tap_ww * ww; }
    IMGMESH_INLINE int energy_at(int x) const { return energy[x] + 4 * size_w + 2 * size_ww; }

    /// Notes the pixel's value and the number of its residual.
    IMGMESH_INLINE void note(int x, std::int16_t stored, int number) {
        value[x] = stored;
        ww = w;
        w = stored;
        size_ww = size_w;
        size_w = std::min(magnitude_of(number), kMaxMagnitude);
        size[x] = static_cast<std::uint8_t>(size_w);
    }
};

struct Lane {
    ComponentLane x, y;
    const std::int16_t* slope = nullptr;

    /// Of the row for which `rows.next()` was called last.
    IMGMESH_INLINE Lane(BandRows& rows, const std::array<Taps, 2>& taps) : slope(rows.slope.get()) {
        begin(x, rows.x, taps[0], rows.first_row());
        begin(y, rows.y, taps[1], rows.first_row());
    }

  private:
    static IMGMESH_INLINE void begin(ComponentLane& lane, ComponentRows& rows, const Taps& taps,
                                     bool first_row) {
        lane.value = rows.value.get();
        lane.plain = rows.plain.get();
        lane.size = rows.size.get();
        lane.prediction = rows.prediction.get();
        lane.energy = rows.energy.get();
        // The first row is predicted by the pixel on the left alone.
        lane.tap_w = first_row ? 1 << kTapBits : taps[0];
        lane.tap_ww = first_row ? 0 : taps[1];
        lane.w = lane.ww = rows.value[-1];
    }
};

/// Returns the value that a prediction and the number of its residual give. Displacements are numbers of 16
/// bits, and sums of them wrap.
IMGMESH_INLINE std::int16_t value_of(int predicted, int number) {
    return static_cast<std::int16_t>(whole_of(predicted) + residual_of(number, has_negative_rest(predicted)));
}

/// Codes pixel x. source.code<COMPONENT>(predicted, energy, x, value) tells the number of a component's
/// residual, which is turned where the prediction has a negative rest: what lies on the rest's side is
/// likelier. It sets the value to value_of() both.
template <typename Source>
IMGMESH_INLINE void code_pixel(Lane& lane, int x, Source& source) {
    std::int16_t value = 0;
    const int predicted_x = lane.x.predicted(x), energy_y = lane.y.energy_at(x),
              number_x =
                  source.template code<0>(predicted_x, lane.x.energy_at(x) + (energy_y >> 3), x, value);
    lane.x.note(x, value, number_x);
    lane.x.plain[x] = static_cast<std::int16_t>(value - whole_of(predicted_x));

    // dx's residual, with the rest, says by the slope of the rows above what dy's will be.
    const std::int64_t exact_x = std::int64_t{value} * (1 << kTapBits) - predicted_x;
    const int plain_y = lane.y.predicted(x),
              predicted_y = plain_y + static_cast<int>((lane.slope[x] * exact_x) >> kSlopeBits),
              number_y = source.template code<1>(predicted_y, energy_y + 2 * lane.x.size_w, x, value);
    lane.y.note(x, value, number_y);
    lane.y.plain[x] = static_cast<std::int16_t>(value - whole_of(plain_y));
}

}  // namespace imgmesh::compact
