// Decodes the displacements of bands. Internal to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/compact/band_tables.h"

namespace imgmesh::compact {

/// The tables of a part, laid out for the decoder.
struct DecodeTables {
    explicit DecodeTables(const BandTables& from);

    std::array<Taps, 2> taps;
    /// The table of a context: [component][class][energy].
    std::array<std::array<std::array<std::uint8_t, kEnergies>, kClasses>, 2> table_of;
    /// For each slot of a table, from the lowest bits on: its token's frequency, the slot's place among the
    /// token's, and the residual of a plain token (signed) or kFirstRange + token - kPlainTokens.
    static constexpr int kPlaceShift = 16, kResidualShift = kPlaceShift + kFrequencyBits;
    static constexpr int kFirstRange = magnitude_of(kPlainTokens - 1) + 1;
    using TableSlots = std::array<std::uint32_t, 1 << kFrequencyBits>;
    std::vector<TableSlots> tables;
};

/// A band and its bytes. `inside` is empty if all pixels are; pixels outside get 0.
struct CodedBand {
    std::span<const std::uint8_t> bytes;
    int width = 0, rows = 0;
    std::span<std::int16_t> dx, dy;
    std::span<const std::uint8_t> inside;
};

/// Fills a band, or two of one part in the time of little more than one (`second` may be null). Returns
/// whether the bytes are bands of these sizes. Safe for any bytes.
bool decode_bands(const CodedBand& first, const CodedBand* second, const DecodeTables& tables);

}  // namespace imgmesh::compact
