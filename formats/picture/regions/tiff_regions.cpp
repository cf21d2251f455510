// Regions of a TIFF, of the strips or tiles that they touch.
#include "formats/picture/decode/tiff_picture.h"
#include "formats/picture/decode/tiff_rows.h"
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/spool_tiff.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

bool is_one_stream(const TiffFile& file) {
    return file.tag<std::uint16_t>(TIFFTAG_COMPRESSION, COMPRESSION_NONE) == COMPRESSION_OJPEG;
}

class TiffDecoder : public RegionDecoder {
  public:
    TiffDecoder(const std::string& path, const ReadImageOptions& options)
        : options_(options),
          file_(path),
          tiff_(file_),
          picture_(tiff_, options_, source_limits(options, file_.size())) {
        if (is_spooled(tiff_, picture_.layout())) picture_.read_by_rows();
    }

    DecodedPicture decode(const PixelRect& stored) override { return picture_.read(stored); }

    PictureHeader header() {
        const TiffLayout& layout = picture_.layout();
        PictureHeader out;
        out.width = static_cast<int>(layout.width);
        out.height = static_cast<int>(layout.height);
        out.block_width = static_cast<int>(layout.block_width);
        out.block_height = static_cast<int>(layout.block_height);
        out.zero_pixel = picture_.zero_pixel();
        std::int64_t held = layout.block_width * layout.block_height * layout.samples;
        std::uint64_t packed = 0;
        if (picture_.by_rows()) {
            if (has_plain_rows(tiff_)) {
                out.block_height = 1;
            } else {
                out.access = RegionAccess::kSpool;
                out.by_rows = true;
                out.why = cat("it is a TIFF in strips of ", layout.block_height, " rows");
            }
            held = layout.width * layout.samples;
            packed = held_strip(tiff_, layout);
        } else if (is_one_stream(tiff_)) {
            out.access = RegionAccess::kWhole;
            out.why = "it is a TIFF of old-style JPEG, which is one stream";
        } else if (held > kMostInBlock) {
            out.access = RegionAccess::kWhole;
            out.why =
                cat("it is a TIFF in blocks of ", layout.block_width, "x", layout.block_height, " pixels");
        }
        // As packed and unpacked, and places and lengths of all blocks.
        const auto bytes = static_cast<std::uint64_t>((held * layout.bits + 7) / 8);
        const std::int64_t blocks =
            layout.blocks_across() * layout.blocks_down() * (layout.planar ? layout.samples : 1);
        out.decode_bytes = packed + 2 * bytes + 16 * static_cast<std::uint64_t>(blocks);
        return out;
    }

  private:
    const ReadImageOptions options_;
    RandomFile file_;
    TiffFile tiff_;
    TiffPicture picture_;
};

}  // namespace

std::unique_ptr<RegionReader> open_tiff_regions(const std::string& path, const ReadImageOptions& options) {
    PictureHeader header = TiffDecoder(path, options).header();
    return open_decoded(path, options, std::move(header),
                        [path, options] { return std::make_unique<TiffDecoder>(path, options); });
}

}  // namespace imgmesh
