// A compact stream band by band, for who does not want the whole map in memory.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/exr/exr_layers.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

class Findings;

/// Rows of pixels to fill; `inside` is empty where a part has no mask, `visits` where nobody wants them.
struct CompactRows {
    std::span<std::int16_t> dx, dy;  ///< [1 / steps pixel]
    std::span<std::uint8_t> inside;  ///< 0 or 1
    std::span<Id> visits;
};

/// The parts of a compact stream, whose bytes must outlive this object. All functions but the constructor may
/// be called by several threads at a time.
class CompactStream {
  public:
    /// What is known of a part before its pixels.
    struct Part {
        std::string name;
        int steps = 16;
        int band_rows = 1;  ///< of every band but the last, which may have fewer
        int bands = 0;      ///< 0 for a part with errors
        WeightPrecision precision = WeightPrecision::kFloat;
        bool has_mask = false, has_visits = false;
        std::string topology;
    };

    /// Reads the headers and the tables. Errors as for decode_compact_layers().
    CompactStream(std::span<const std::uint8_t> bytes, const ExpectedLayers& expected, Findings& findings);
    ~CompactStream();
    CompactStream(CompactStream&&) noexcept;

    /// In the order of the expected parts.
    const std::vector<Part>& parts() const { return parts_; }

    /// Decodes a band: the rows from band * band_rows on. Bands need no others. Throws FindingError.
    void decode(std::size_t part, int band, const CompactRows& rows) const;
    /// Decodes one band or two, `first` and the next, faster than one after the other.
    void decode(std::size_t part, int first, std::span<const CompactRows> bands) const;

  private:
    struct Coded;
    std::vector<Part> parts_;
    std::unique_ptr<Coded> coded_;
};

}  // namespace imgmesh
