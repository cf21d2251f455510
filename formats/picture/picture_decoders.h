// Shared by read_image()'s decoders and write_image()'s encoders. A decoder turns the bytes of a file into
// samples; read_image() does the rest (alpha, orientation, finite samples) for all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/files/one_line.h"
#include "formats/picture/picture_probe.h"
#include "libcore/image/image.h"

namespace imgmesh {

struct DecodedPicture {
    Image image;  ///< as stored; its color_space is not set
    bool associated_alpha = false;
    int orientation = 1;                    ///< of EXIF, 1 to 8
    std::optional<ColorSpace> color_space;  ///< if the file names one
};

/// Each throws Error(kBadFile) for broken or truncated content and sizes over `limits`, before memory is
/// taken for the pixels, and kUnsupported for kinds of images that imgmesh does not use.
DecodedPicture decode_with_oiio(const std::string& path, std::span<const std::uint8_t> bytes,
                                const PictureClaim& claim, const ImageLimits& limits);
DecodedPicture decode_png(const std::string& path, std::span<const std::uint8_t> bytes,
                          const PictureClaim& claim, const ImageLimits& limits);
DecodedPicture decode_webp(const std::string& path, std::span<const std::uint8_t> bytes,
                           const ImageLimits& limits);
/// `bytes` is changed (see exr_opaque.h). `any_primaries`: the caller knows the colour space, so
/// chromaticities other than Rec.709's are no error.
DecodedPicture decode_exr(const std::string& path, std::span<std::uint8_t> bytes, const ImageLimits& limits,
                          bool any_primaries);

/// Each returns the bytes of a file of an image that is ready for it. EXR: `image` is linear with associated
/// alpha, `type` kHalf or kFloat. WebP: sRGB, 8 bit, lossless, at most 16383 pixels a side. PNG: one to four
/// channels, RGB in any colour space, `type` kUint8 or kUint16.
std::vector<std::uint8_t> encode_exr(const Image& image, SampleType type);
std::vector<std::uint8_t> encode_webp(const Image& image);
std::vector<std::uint8_t> encode_png(const Image& image, SampleType type);

}  // namespace imgmesh
