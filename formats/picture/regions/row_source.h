// Pictures that can only be read from the top, row by row. Internal to this room.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "formats/picture/decode/picture_decoders.h"

namespace imgmesh {

/// The rows of a picture, as codes of 8 bits, or of 16 in the machine's order.
struct RowLayout {
    int width = 0, height = 0;
    int channels = 1;  ///< grey, grey and alpha, RGB, RGBA, or four inks
    int bits = 8;
    int orientation = 0;  ///< 1 to 8; 0 if it is not said
    StatedColor color;
    bool inks_upside_down = false;  ///< 0 is full ink
    std::vector<std::string> warnings;

    std::size_t row_bytes() const {
        return static_cast<std::size_t>(width) * static_cast<std::size_t>(channels * bits / 8);
    }
};

/// Holds a few rows, and of progressive JPEG the coefficients of all.
class RowSource {
  public:
    RowSource() = default;
    virtual ~RowSource() = default;
    RowSource(const RowSource&) = delete;
    RowSource& operator=(const RowSource&) = delete;

    virtual const RowLayout& layout() const = 0;
    /// Reads the next row of layout().row_bytes(). Throws Error(kBadFile) for a broken or truncated file.
    virtual void read(std::span<std::uint8_t> row) = 0;
    /// After the last row: throws if the file turns out to be broken, and returns warnings.
    virtual std::vector<std::string> finish() = 0;
};

/// Each reads the header. Throws Error as read_image_file() does.
std::unique_ptr<RowSource> open_png_rows(const std::string& path, const ReadImageOptions& options);
std::unique_ptr<RowSource> open_jpeg_rows(const std::string& path, const ReadImageOptions& options);

/// The picture of one pixel of zeros that has all else of such rows.
DecodedPicture zero_pixel(const RowLayout& layout);

}  // namespace imgmesh
