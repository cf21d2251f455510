// Encodes the displacements of bands, in two passes: the tokens of all bands decide the tables, by which they
// are then coded. Internal to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/compact/band_tables.h"

namespace imgmesh::compact {

/// Rows of displacements, row by row; `inside` is empty if all pixels are.
struct Band {
    int width = 0, rows = 0;
    std::span<const std::int16_t> dx, dy;
    std::span<const std::uint8_t> inside;
};

/// A band as tokens, in the order of decoding: of each pixel inside that of dx, then that of dy.
struct BandTokens {
    std::vector<std::uint16_t> tokens;  ///< context * kTokens + token
    std::vector<std::uint16_t> bits;    ///< those that follow the tokens from kPlainTokens on
    TokenCounts counts{};
};

BandTokens band_tokens(const Band& band, const std::array<Taps, 2>& taps);

/// Appends the bytes of a band.
void put_band(std::vector<std::uint8_t>& out, const BandTokens& band, const BandTables& tables);

}  // namespace imgmesh::compact
