// The tables of a part: the taps of its predictions, and the frequencies of tokens in each context. Internal
// to this room.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/compact/residual_model.h"

namespace imgmesh::compact {

/// How often each token occurs in each context: [component][class][level][token].
using TokenCounts =
    std::array<std::array<std::array<std::array<std::uint32_t, kTokens>, kLevels>, kClasses>, 2>;

/// The frequency of a token among 1 << kFrequencyBits, and the sum of those before.
struct Slots {
    std::uint16_t frequency = 0;
    std::uint16_t first = 0;
};
using TokenSlots = std::array<Slots, kTokens>;

struct BandTables {
    std::array<Taps, 2> taps{};
    std::vector<TokenSlots> tables;
    /// Which of `tables` a context has: [component][class][level].
    std::array<std::array<std::array<std::uint8_t, kLevels>, kClasses>, 2> table_of{};
};

/// Makes the tables for these counts. Neighbouring levels share a table where that takes fewer bits. Returns
/// their bytes; what a reader makes of them is what the writer has to use.
std::vector<std::uint8_t> table_bytes(const std::array<Taps, 2>& taps, const TokenCounts& counts);

/// Reads the tables. Returns nothing if the bytes are none. Safe for any bytes.
std::optional<BandTables> read_tables(std::span<const std::uint8_t> bytes);

}  // namespace imgmesh::compact
