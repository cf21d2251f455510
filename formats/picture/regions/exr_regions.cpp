// Regions of an EXR, of the chunks of lines or the tiles that they touch.
#include <optional>

#include "formats/exr/file_input.h"
#include "formats/picture/decode/exr_picture.h"
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/spool_exr.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

class ExrDecoder : public RegionDecoder {
  public:
    ExrDecoder(const std::string& path, const ReadImageOptions& options)
        : options_(options), file_(path), stream_(file_) {
        open();
    }

    DecodedPicture decode(const PixelRect& stored) override {
        if (!picture_) open();
        DecodedPicture out = picture_->read(stored);
        // Where chunks of lines follow each other, OpenEXR does not look at their places in the table. What a
        // region has must not depend on the one before, so each begins with a place.
        if (!picture_->block().tile) picture_.reset();
        return out;
    }

    PictureHeader header() const {
        const ExrBlock& block = picture_->block();
        PictureHeader out;
        out.width = picture_->width();
        out.height = picture_->height();
        out.block_width = static_cast<int>(block.width);
        out.block_height = static_cast<int>(block.height);
        out.zero_pixel = picture_->zero_pixel();
        if (block.width * block.height * block.channels > kMostInBlock) {
            out.access = RegionAccess::kWhole;
            out.why = cat("it is an EXR in blocks of ", block.width, "x", block.height, " pixels and ",
                          block.channels, " channels");
        }
        if (out.access == RegionAccess::kDirect && is_spooled(*picture_)) {
            out.access = RegionAccess::kSpool;
            out.why = "it is an EXR in packed lines";
        }
        // As packed, as unpacked, and what lies between them; a row or tile of samples; the table of places.
        const std::int64_t samples = block.width * block.height * block.channels;
        out.decode_bytes = static_cast<std::uint64_t>(4 * block.bytes + 4 * samples) +
                           8 * static_cast<std::uint64_t>(picture_->block_count());
        return out;
    }

  private:
    void open() {
        stream_.seekg(0);
        picture_.emplace(file_.path(), stream_, options_, source_limits(options_, file_.size()));
    }

    const ReadImageOptions options_;
    RandomFile file_;
    FileInput stream_;
    std::optional<ExrPicture> picture_;
};

}  // namespace

std::unique_ptr<RegionReader> open_exr_regions(const std::string& path, const ReadImageOptions& options) {
    PictureHeader header = ExrDecoder(path, options).header();
    return open_decoded(path, options, std::move(header),
                        [path, options] { return std::make_unique<ExrDecoder>(path, options); });
}

}  // namespace imgmesh
