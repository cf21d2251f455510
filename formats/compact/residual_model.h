// How a displacement is predicted, and in which context its residual is coded: what encoder and decoder must
// agree on. Internal to this room. docs/format.md says the same in words, docs/decisions/0034-compact-map.md
// why.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>

namespace imgmesh::compact {

/// The neighbours of a prediction, in this order: W, WW, N, NW, NE, NN, NWW, NEE, NNW, NNE.
inline constexpr int kTaps = 10;
/// Coefficients are multiples of 1/256 below 4, so that no sum of them leaves 32 bits.
inline constexpr int kTapBits = 8, kMaxTap = 1023;
using Taps = std::array<std::int16_t, kTaps>;

/// Magnitudes of residuals count up to this in contexts, so that no energy reaches kEnergies.
inline constexpr int kMaxMagnitude = 80;
/// Residuals count up to this in slopes, so that sums of their products fit into 16 bits.
inline constexpr int kMaxProduct = 31;
/// A slope has 6 bits behind the point and is at most 4.
inline constexpr int kSlopeBits = 6, kMaxSlope = 256, kSlopeStart = 16;

/// Contexts: a level of the neighbours' magnitudes, and a class of the prediction's fraction.
inline constexpr int kLevels = 22, kClasses = 3, kEnergies = 2048;

/// Returns the level of an energy: two in an octave.
constexpr int level_of(int energy) {
    if (energy < 4) return energy;
    const int octave = std::bit_width(static_cast<unsigned>(energy)) - 1;
    return 2 * octave + ((energy >> (octave - 1)) & 1);
}

/// Returns a prediction as a whole number, the nearest.
constexpr int whole_of(int prediction) {
    return (prediction + (1 << (kTapBits - 1))) >> kTapBits;
}
/// Returns whether the rest of a prediction, without its whole number, is negative.
constexpr bool has_negative_rest(int prediction) {
    return (prediction >> (kTapBits - 1)) & 1;
}
/// Returns the class of a prediction by the magnitude of its rest.
constexpr int class_of(int prediction) {
    const int rest = prediction - whole_of(prediction) * (1 << kTapBits), magnitude = rest < 0 ? -rest : rest;
    return (magnitude >= 32) + (magnitude >= 80);
}
/// Returns which of a component's contexts a prediction and an energy give: class * kLevels + level.
constexpr int context_of(int prediction, int energy) {
    return class_of(prediction) * kLevels + level_of(energy);
}

/// Tokens: the numbers below kPlainTokens stand for themselves, the others for a range of numbers, of which
/// the next bits say one.
inline constexpr int kTokens = 32, kPlainTokens = 24;
inline constexpr std::array<int, kTokens - kPlainTokens> kTokenBits = {3, 4, 5, 6, 7, 8, 10, 16},
                                                         kTokenFirst = {24, 32, 48, 80, 144, 272, 528, 1552};

/// Returns -number if `turn`, without a branch.
constexpr int turned(int number, bool turn) {
    const int mask = -static_cast<int>(turn);
    return (number ^ mask) - mask;
}

/// Residuals as numbers: 0, 1, -1, 2, -2, ... are 0, 1, 2, 3, 4, ...
constexpr int number_of(int residual) {
    return 2 * turned(residual, residual < 0) - static_cast<int>(residual > 0);
}
constexpr int magnitude_of(int number) {
    return (number + 1) >> 1;
}
constexpr int residual_of(int number, bool turn = false) {
    return turned(magnitude_of(number), ((number & 1) == 0) != turn);
}

/// rANS (Duda 2013): states of 32 bits from kLowest on, words of 16 bits, frequencies that sum to a power of
/// two.
inline constexpr int kFrequencyBits = 10, kWordBits = 16;
inline constexpr std::uint32_t kLowest = 1u << kWordBits;

}  // namespace imgmesh::compact
