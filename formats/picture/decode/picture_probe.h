// Reads what an image file says about itself before any library takes memory for it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "formats/picture/image_io.h"

namespace imgmesh {

enum class PictureFormat { kPng, kJpeg, kTiff, kExr, kWebp, kGif, kBmp, kPnm, kTga, kHdr, kJpeg2000, kHeif };

/// The size by the first bytes; 0 if the decoder tells it, which then does so without taking memory for the
/// pixels.
struct PictureClaim {
    PictureFormat format;
    std::int64_t width = 0;
    std::int64_t height = 0;
    std::int64_t channels = 0;
};

/// Recognises the format by the content, not by the name (except TGA, which may have no signature, by its
/// extension). Throws Error: kBadFile for no image; kUnsupported for camera raw files and other formats that
/// imgmesh knows by name alone.
PictureClaim probe_picture(const std::string& path, std::span<const std::uint8_t> bytes);

/// Throws Error(kBadFile) if the size is not positive or over the limits, that of memory included.
void check_size(const std::string& path, std::int64_t width, std::int64_t height, std::int64_t channels,
                const ImageLimits& limits);

/// Returns the limits for a file of so many bytes. Of those, max_pixels_per_byte is 0 where it does not
/// matter.
ImageLimits limits_for_bytes(ImageLimits limits, std::uint64_t bytes);

/// check_size() of a tile, with which the caller does no work.
void check_block_size(const std::string& path, std::int64_t width, std::int64_t height, std::int64_t channels,
                      ImageLimits limits);

}  // namespace imgmesh
