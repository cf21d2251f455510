// Strips of a TIFF that are undone row by row. Internal to this room.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "formats/picture/decode/tiff_layout.h"
#include "formats/picture/decode/tiff_streams.h"

namespace imgmesh {

/// Whether the strips can be undone so: not tiles, not those of codecs that know whole strips only, not
/// samples in groups, and none left out; those that are held as packed are not above kMostAtOnce.
bool has_rows(const TiffFile& file, const TiffLayout& layout);

/// What TiffRows holds of the strips as packed, at most [bytes].
std::uint64_t held_strip(const TiffFile& file, const TiffLayout& layout);

/// Undoes rows. libtiff holds the strip as packed, for codecs that TiffStreams does not know. Those of a
/// strip come one after the other: going back begins the strip again.
class TiffRows {
  public:
    /// Both must outlive it. Throws Error(kBadFile) if libtiff's rows have another length.
    TiffRows(TiffFile& file, const TiffLayout& layout);

    std::size_t row_bytes() const { return row_bytes_; }  ///< of one plane
    std::int64_t strip(std::int64_t y) const { return y / layout_.block_height; }
    /// Reads row y of a plane, as stored in the machine's order. Goes through all of a packed strip before
    /// the first row of it, as what is above a broken row may be wrong already. Throws Error(kBadFile) for a
    /// strip that is broken or truncated anywhere.
    void read(std::int64_t y, int plane, std::span<std::uint8_t> row);

  private:
    void check(std::int64_t index, int plane, std::span<std::uint8_t> row);
    void read_unchecked(std::int64_t y, int plane, std::span<std::uint8_t> row);
    void read_by_libtiff(std::int64_t y, int plane, std::span<std::uint8_t> row);

    TiffFile& file_;
    const TiffLayout& layout_;
    std::size_t row_bytes_;
    std::optional<TiffStreams> streams_;
    std::vector<char> checked_;  ///< strips
};

}  // namespace imgmesh
