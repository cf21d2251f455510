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

/// What is on the left of a pixel of a component, and the taps for it.
struct ComponentLane {
    int tap_w = 0, tap_ww = 0;
    int w = 0, ww = 0, size_w = 0, size_ww = 0;
};

/// A row in the hands of a loop over its pixels.
struct Lane {
    Chunk* chunk = nullptr;
    ComponentLane x, y;

    /// Of the row for which `rows.next_row()` was called last.
    IMGMESH_INLINE Lane(BandRows& rows, const std::array<Taps, 2>& taps) : chunk(&rows.chunk) {
        for (std::size_t k = 0; k < 2; ++k) {
            ComponentLane& lane = k == 0 ? x : y;
            // The first row is predicted by the pixel on the left alone.
            lane.tap_w = rows.first_row() ? 1 << kTapBits : taps[k][0];
            lane.tap_ww = rows.first_row() ? 0 : taps[k][1];
            lane.w = lane.ww = rows.left(k);
        }
    }

    /// The parts of prediction and energy that the pixels on the left have are added to those of the rows
    /// above.
    template <std::size_t kComponent>
    IMGMESH_INLINE int predicted(int i) const {
        const ComponentLane& lane = kComponent == 0 ? x : y;
        return chunk->prediction.data()[kComponent].data()[i] + lane.tap_w * lane.w + lane.tap_ww * lane.ww;
    }
    template <std::size_t kComponent>
    IMGMESH_INLINE int energy(int i) const {
        const ComponentLane& lane = kComponent == 0 ? x : y;
        return chunk->energy.data()[kComponent].data()[i] + 4 * lane.size_w + 2 * lane.size_ww;
    }
    /// Notes a pixel's value, the magnitude of its residual and its residual without the slope.
    template <std::size_t kComponent>
    IMGMESH_INLINE void note(int i, std::int16_t value, int size, int plain) {
        ComponentLane& lane = kComponent == 0 ? x : y;
        lane.ww = lane.w;
        lane.w = value;
        lane.size_ww = lane.size_w;
        lane.size_w = size;
        chunk->value.data()[kComponent].data()[i] = value;
        chunk->plain.data()[kComponent].data()[i] = static_cast<std::int16_t>(plain);
        chunk->size.data()[kComponent].data()[i] = static_cast<std::uint16_t>(size);
    }
};

/// Returns the value that a prediction and a residual give, which is turned where the prediction has a
/// negative rest: what lies on the rest's side is likelier. Displacements are numbers of 16 bits, and sums of
/// them wrap.
IMGMESH_INLINE std::int16_t value_of(int predicted, int residual) {
    // With the bits of the whole number turned first and last, little is left to do when the residual is
    // known.
    const int turn = -static_cast<int>(has_negative_rest(predicted));
    return static_cast<std::int16_t>(((whole_of(predicted) ^ turn) + residual) ^ turn);
}

/// Codes pixel i of the chunk. source.code<COMPONENT>(predicted, energy, i, value) tells the magnitude of a
/// component's residual, kMaxMagnitude at most, and sets the value.
template <typename Source>
IMGMESH_INLINE void code_pixel(Lane& lane, int i, Source& source) {
    std::int16_t value = 0;
    const int predicted_x = lane.predicted<0>(i), energy_y = lane.energy<1>(i),
              size_x = source.template code<0>(predicted_x, lane.energy<0>(i) + (energy_y >> 3), i, value);
    lane.note<0>(i, value, size_x, value - whole_of(predicted_x));

    // dx's residual, with the rest, says by the slope of the rows above what dy's will be.
    const std::int64_t exact_x = std::int64_t{value} * (1 << kTapBits) - predicted_x;
    const int plain_y = lane.predicted<1>(i),
              predicted_y = plain_y + static_cast<int>((lane.chunk->slope.data()[i] * exact_x) >> kSlopeBits),
              size_y = source.template code<1>(predicted_y, energy_y + 2 * lane.x.size_w, i, value);
    lane.note<1>(i, value, size_y, value - whole_of(plain_y));
}

}  // namespace imgmesh::compact
