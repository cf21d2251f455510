// The headers of a compact stream and its bands of rows; internal to this room, but for compact_bands.h.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "formats/exr/exr_layers.h"
#include "libcore/base/grid.h"

namespace imgmesh {

class Findings;

inline constexpr std::uint8_t kCompactMagic[] = {'I', 'M', 'A', 'P'};
inline constexpr int kCompactMajor = 1, kCompactMinor = 0;
/// A band has at least a byte for this many pixels, so that the bytes bound the pixels.
inline constexpr std::size_t kPixelsOfByte = 1024;

/// What precedes the pixels of a part.
struct CompactHeader : GridSize {
    std::string name;
    int steps = 8;
    int band_rows = 1;
    WeightPrecision precision = WeightPrecision::kFloat;
    bool has_mask = false, has_visits = false;
    std::string topology;                              ///< 64 digits, or empty
    std::span<const std::uint8_t> tables;              ///< of the bands' coder
    std::vector<std::span<const std::uint8_t>> bands;  ///< from the top

    int rows(std::size_t band) const;
};

/// Returns the rows of a band: so many that starting without neighbours above costs little.
int band_rows_of(const GridSize& size);

/// Appends the header of a stream.
void put_stream_header(std::vector<std::uint8_t>& out, std::size_t parts);
/// Appends a part: header, tables and bands.
void put_part(std::vector<std::uint8_t>& out, const CompactHeader& header);

/// Reads all headers. Throws FindingError for a stream that is broken, or is not as `expected`; the parts
/// that are missing from a stream are reported to `findings` and have no bands.
std::vector<CompactHeader> read_compact_headers(std::span<const std::uint8_t> bytes,
                                                const ExpectedLayers& expected, Findings& findings);

}  // namespace imgmesh
