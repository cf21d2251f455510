// Regions of a picture whose file has them in blocks. Internal to this room.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "formats/picture/decode/picture_decoders.h"
#include "formats/picture/regions/region_reader.h"

namespace imgmesh {

/// Samples of one block, which is read as a whole: above any tile, and memory for it is little.
inline constexpr std::int64_t kMostInBlock = std::int64_t{1} << 26;

/// Decodes parts of one file. One thread at a time.
class RegionDecoder {
  public:
    RegionDecoder() = default;
    virtual ~RegionDecoder() = default;
    RegionDecoder(const RegionDecoder&) = delete;
    RegionDecoder& operator=(const RegionDecoder&) = delete;

    /// The pixels of `stored`, a rectangle of the picture as it is stored.
    virtual DecodedPicture decode(const PixelRect& stored) = 0;
};

/// What the header of a picture says.
struct PictureHeader {
    int width = 0, height = 0;  ///< as stored
    int block_width = 0, block_height = 0;
    DecodedPicture zero_pixel;  ///< a picture of one pixel of zeros: what does not depend on pixels
    RegionAccess access = RegionAccess::kDirect;
    bool by_rows = false;  ///< kSpool: a part that lies above the one before costs all rows down to it
    std::string why;       ///< not kDirect: PictureFacts::why
    std::uint64_t decode_bytes = 0;  ///< what a decoder takes beside its result, at most
};

/// The limits of a picture of which only parts are read, from a file of so many bytes.
ImageLimits source_limits(const ReadImageOptions& options, std::uint64_t file_bytes);

/// `open` makes a decoder for each thread that reads. Without it, and for kWhole, the whole picture is read
/// when the first region is; for rows when one is above the one before, if the limits of an image allow it.
std::unique_ptr<RegionReader> open_decoded(const std::string& path, const ReadImageOptions& options,
                                           PictureHeader header,
                                           std::function<std::unique_ptr<RegionDecoder>()> open);

std::unique_ptr<RegionReader> open_tiff_regions(const std::string& path, const ReadImageOptions& options);
/// Of Netpbm; one of text is read as a whole.
std::unique_ptr<RegionReader> open_pnm_regions(const std::string& path, const ReadImageOptions& options);
std::unique_ptr<RegionReader> open_exr_regions(const std::string& path, const ReadImageOptions& options);
/// With RegionAccess::kSpool. Throws Error(kUnsupported) for an interlaced PNG.
std::unique_ptr<RegionReader> open_png_regions(const std::string& path, const ReadImageOptions& options);
std::unique_ptr<RegionReader> open_jpeg_regions(const std::string& path, const ReadImageOptions& options);

}  // namespace imgmesh
