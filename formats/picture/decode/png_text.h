// Orientation in a PNG's text chunks: EXIF as ImageMagick and others write it, and XMP.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "formats/picture/decode/exif.h"

namespace imgmesh {

/// Returns the content of a zlib stream, or nothing if it is broken or has more than `most` bytes.
std::vector<std::uint8_t> inflated(std::span<const std::uint8_t> zlib, std::size_t most);

class PngText {
  public:
    /// Takes a chunk named tEXt, zTXt or iTXt. Only those with metadata are unpacked, and at most 1 MiB.
    void add(std::string_view chunk, std::span<const std::uint8_t> content);
    /// 1 to 8, that of EXIF before that of XMP; 0 if it is not said.
    int orientation() const { return exif_ ? exif_ : xmp_; }

  private:
    int exif_ = 0, xmp_ = 0;
    int unpacked_ = 0;
};

}  // namespace imgmesh
