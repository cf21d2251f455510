// Decodes the displacements of bands. Internal to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/compact/band_tables.h"

namespace imgmesh::compact {

/// The tables of a part, laid out for the decoder.
struct DecodeTables {
    explicit DecodeTables(const BandTables& tables);

    std::array<Taps, 2> taps;
    /// The table of a context: [component][class][energy].
    std::array<std::array<std::array<std::uint8_t, kMaxEnergy + 1>, kClasses>, 2> table_of;
    std::vector<std::array<std::uint8_t, 1 << kFrequencyBits>> token_of;  ///< of each table's slots
    std::vector<TokenSlots> slots;                                        ///< of each table's tokens
};

/// A band and its bytes. `inside` is empty if all pixels are; pixels outside get 0.
struct CodedBand {
    std::span<const std::uint8_t> bytes;
    int width = 0, rows = 0;
    std::span<std::int16_t> dx, dy;
    std::span<const std::uint8_t> inside;
};

/// Fills a band; returns whether the bytes are a band of that size. Safe for any bytes.
bool decode_band(const CodedBand& band, const DecodeTables& tables);

}  // namespace imgmesh::compact
