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

/// Magnitudes of residuals count up to this in contexts.
inline constexpr int kMaxMagnitude = 255;
/// Residuals count up to this in slopes, so that sums of their products fit into 16 bits.
inline constexpr int kMaxProduct = 31;
/// A slope has 6 bits behind the point and is at most 4.
inline constexpr int kSlopeBits = 6, kMaxSlope = 256, kSlopeStart = 16;

/// Contexts: a level of the neighbours' magnitudes, and a class of the prediction's fraction.
inline constexpr int kLevels = 22, kClasses = 3, kMaxEnergy = 2047;

/// Returns the level of an energy from 0 to kMaxEnergy: two in an octave.
constexpr int level_of(int energy) {
    if (energy < 4) return energy;
    const int octave = std::bit_width(static_cast<unsigned>(energy)) - 1;
    return 2 * octave + ((energy >> (octave - 1)) & 1);
}

/// A prediction, split into a whole number, the class of the rest and whether the rest is negative.
struct Rounded {
    int whole;
    int rest_class;
    bool negative;
};
constexpr Rounded rounded(int prediction) {
    constexpr int kHalf = 1 << (kTapBits - 1);
    const int whole = (prediction + kHalf) >> kTapBits, rest = prediction - whole * (2 * kHalf),
              size = rest < 0 ? -rest : rest;
    return {whole, (size >= 32) + (size >= 80), rest < 0};
}

/// Tokens: the numbers below kPlainTokens stand for themselves, the others for a range of numbers, of which
/// the next bits say one.
inline constexpr int kTokens = 32, kPlainTokens = 24;
inline constexpr std::array<int, kTokens - kPlainTokens> kTokenBits = {3, 4, 5, 6, 7, 8, 10, 16},
                                                         kTokenFirst = {24, 32, 48, 80, 144, 272, 528, 1552};

/// Residuals as numbers: 0, 1, -1, 2, -2, ... are 0, 1, 2, 3, 4, ...
constexpr int number_of(int residual) {
    return residual > 0 ? 2 * residual - 1 : -2 * residual;
}
constexpr int residual_of(int number) {
    return number & 1 ? (number + 1) >> 1 : -(number >> 1);
}

/// rANS (Duda 2013): states of 32 bits from kLowest on, words of 16 bits, frequencies that sum to a power of
/// two.
inline constexpr int kFrequencyBits = 11, kWordBits = 16;
inline constexpr std::uint32_t kLowest = 1u << kWordBits;

}  // namespace imgmesh::compact
