// Shared by read_image()'s decoders. A decoder turns the bytes of a file into samples; read_image() does the
// rest (alpha, colour, orientation, finite samples) for all of them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/files/one_line.h"
#include "formats/picture/color/primaries.h"
#include "formats/picture/color/stated_color.h"
#include "formats/picture/decode/picture_probe.h"
#include "libcore/image/image.h"

namespace imgmesh {

/// A file to decode. What it refers to must outlive it.
struct PictureFile {
    const std::string& path;
    std::span<std::uint8_t> bytes;  ///< decode_exr() changes them (see exr_opaque.h)
    PictureClaim claim;
    const ReadImageOptions& options;
};

struct DecodedPicture {
    Image image;  ///< as stored; its color_space is not set
    bool associated_alpha = false;
    int orientation = 1;  ///< of EXIF, 1 to 8; 0 if it is not said
    StatedColor color;    ///< what the file says about its colours
    std::vector<std::string> warnings;
    bool has_layers = false;                  ///< of an EXR
    std::optional<Primaries> primaries = {};  ///< of linear RGB, if they are not Rec.709's
    ExrMetadata metadata = {};
    std::optional<ImagePlace> place = {};  ///< in an EXR that left a choice
    Mask data = {};                        ///< see ReadImage; set by decoders that know of such pixels
    float largest_code = 0;     ///< that has become 1; 1 for own numbers, 0 for 255 or 65535 by the type
    bool knows_nodata = false;  ///< options.nodata has been dealt with
};

/// Each throws Error(kBadFile) for broken or truncated content and sizes over the limits, before memory is
/// taken for the pixels, and kUnsupported for kinds of images that imgmesh does not use.
DecodedPicture decode_bmp(const PictureFile& file);
DecodedPicture decode_jpeg(const PictureFile& file);
DecodedPicture decode_pnm(const PictureFile& file);
DecodedPicture decode_tga(const PictureFile& file);
/// In another process (codecs/codec_process.h), as the library may crash.
DecodedPicture decode_with_codecs(const PictureFile& file);
DecodedPicture decode_png(const PictureFile& file);
DecodedPicture decode_tiff(const PictureFile& file);
DecodedPicture decode_webp(const PictureFile& file);
/// Reads the part, layer and channels of the options. The others leave that to read_image().
DecodedPicture decode_exr(const PictureFile& file);

/// Finds out what the bytes are and runs the decoder for it. Files may hold others: a BMP a PNG.
DecodedPicture decode_picture(const std::string& path, std::span<std::uint8_t> bytes,
                              const ReadImageOptions& options);

}  // namespace imgmesh
