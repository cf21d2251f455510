// What read_image's decoders and write_image's encoders share. A decoder turns the bytes of one file into
// samples; read_image does the rest (alpha, orientation, finite samples) for all of them.
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
    std::optional<ColorSpace> color_space;  ///< where the file says one
};

/// Each throws Error(kBadFile) for broken or truncated content and sizes over `limits`, before memory is
/// taken for the pixels; kUnsupported for what imgmesh has no use for.
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

/// The bytes of a file. The image is as it is to be stored: `image` linear with associated alpha for EXR
/// and `type` kHalf or kFloat; sRGB, 8 bit and lossless, at most 16383 pixels a side, for WebP; one to four
/// channels, in RGB of any colour space, for PNG and `type` kUint8 or kUint16.
std::vector<std::uint8_t> encode_exr(const Image& image, SampleType type);
std::vector<std::uint8_t> encode_webp(const Image& image);
std::vector<std::uint8_t> encode_png(const Image& image, SampleType type);

}  // namespace imgmesh
