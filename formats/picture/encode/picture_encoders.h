// Shared by write_image()'s encoders.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "formats/exr/exr_metadata.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// An image as a format holds it.
struct StoredImage {
    Image image;
    SampleType type;
};
/// Returns what write_image() stores in a file of that name, but for a float TIFF of values. Throws as it
/// does.
StoredImage stored_image(const std::string& path, const Image& image, std::optional<SampleType> sample_type);

/// Each returns the bytes of a file of an image that is ready for it. EXR: `image` is linear with associated
/// alpha, `type` kHalf or kFloat, and becomes what WriteImageOptions::metadata says. WebP: sRGB, 8 bit,
/// lossless, at most 16383 pixels a side. PNG: one to four channels, RGB in any colour space, `type` kUint8
/// or kUint16. JPEG: grey, or RGB in any colour space, at most 65500 pixels a side; 8 bit, quality 95, and
/// colour at each pixel.
std::vector<std::uint8_t> encode_exr(Image image, SampleType type, const ExrMetadata& metadata);
std::vector<std::uint8_t> encode_webp(const Image& image);
std::vector<std::uint8_t> encode_jpeg(const Image& image);
std::vector<std::uint8_t> encode_png(const Image& image, SampleType type);

/// Data without a colour as a float TIFF, grey or in bands, with deflate. Where alpha is 0 the numbers are
/// NaN, which the file names as GDAL's nodata; alpha itself is not stored. The same image gives the same
/// bytes.
std::vector<std::uint8_t> encode_tiff_values(const Image& image);

}  // namespace imgmesh
