// Strips of a TIFF that are read while they are undone, as libtiff would hold them as packed. Internal to
// this room.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "formats/picture/decode/inflater.h"
#include "formats/picture/decode/tiff_layout.h"

namespace imgmesh {

/// Whether the strips are without compression, so that each row has a place.
bool has_plain_rows(const TiffFile& file);
/// Whether TiffStreams reads them: those, and deflate with its predictors.
bool has_streams(const TiffFile& file, const TiffLayout& layout);

/// Rows of such strips, in the memory of one. Those of deflate come one after the other: going back begins
/// the strip again.
class TiffStreams {
  public:
    /// Both must outlive it.
    TiffStreams(const TiffFile& file, const TiffLayout& layout, std::size_t row_bytes);
    ~TiffStreams();
    TiffStreams(const TiffStreams&) = delete;
    TiffStreams& operator=(const TiffStreams&) = delete;

    /// As TiffRows::read().
    void read(std::int64_t y, int plane, std::span<std::uint8_t> row);
    /// After the last row of a strip: whether the stream ends with the right checksum, there or after as many
    /// rows again.
    bool ends_well();

  private:
    void begin(std::int64_t strip);
    bool next_bytes();
    bool inflate_row(std::span<std::uint8_t> row);
    void undo_predictor(std::span<std::uint8_t> row);
    void swap_bytes(std::span<std::uint8_t> row) const;

    const TiffFile& file_;
    const TiffLayout& layout_;
    std::size_t row_bytes_;
    std::uint16_t predictor_;
    std::unique_ptr<Inflater> inflater_;  ///< none: without compression
    std::vector<std::uint8_t> packed_, planes_;
    std::int64_t strip_ = -1, next_ = 0;  ///< the row that the stream is at
    bool ended_ = false;                  ///< the stream has
    std::uint64_t at_ = 0, left_ = 0;     ///< of the strip's bytes in the file
};

}  // namespace imgmesh
