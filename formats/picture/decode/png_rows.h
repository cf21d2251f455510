// The rows of a PNG: undoes its filters, and expands palettes, few bits and transparent colours to samples.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "formats/picture/decode/png_chunks.h"

namespace imgmesh {

class PngRows {
  public:
    /// `parts` has a valid header and, for a palette's colour type, a palette; it must outlive this.
    explicit PngRows(const PngParts& parts);

    /// 1 to 4; a palette or a colour that tRNS makes transparent adds alpha.
    int channels() const { return channels_; }
    /// Of a row of that many pixels, without the filter's number.
    std::size_t bytes(int width) const;

    /// Undoes the filters of `height` rows, each after the number of its filter, in place. Returns false for
    /// an unknown one.
    bool undo_filters(std::uint8_t* rows, int width, int height) const;
    /// Writes the samples of a row, integers as code / maximum, correctly rounded.
    void expand(const std::uint8_t* row, int width, float* out) const;

  private:
    std::uint32_t code(const std::uint8_t* row, std::size_t sample) const;

    const PngParts& parts_;
    int stored_ = 1;  ///< channels in the file
    int channels_ = 1;
    std::optional<std::array<std::uint32_t, 3>> clear_ = {};  ///< the transparent colour, of stored_ samples
    std::vector<std::array<float, 4>> palette_;
};

}  // namespace imgmesh
