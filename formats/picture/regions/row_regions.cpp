// Regions of pictures that can only be read from the top: they had better be spooled first.
#include <atomic>
#include <cstring>
#include <memory>

#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/row_source.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

using OpenRows = std::function<std::unique_ptr<RowSource>()>;

// Goes through the rows, and begins again where a part lies above the one before. First once through all, as
// what is above a broken row may be wrong already; `checked` tells the other decoders of the picture.
class RowDecoder : public RegionDecoder {
  public:
    RowDecoder(OpenRows open, std::shared_ptr<std::atomic<bool>> checked)
        : open_(std::move(open)), checked_(std::move(checked)) {}

    DecodedPicture decode(const PixelRect& stored) override {
        if (!*checked_) check();
        if (!rows_ || stored.top < next_) {
            rows_ = open_();
            next_ = 0;
        }
        const RowLayout& layout = rows_->layout();
        row_.resize(layout.row_bytes());
        DecodedPicture out = zero_pixel(layout);
        out.image.width = stored.width();
        out.image.height = stored.height();
        out.image.data.resize(out.image.pixel_count() * static_cast<std::size_t>(layout.channels));
        for (; next_ < stored.bottom; ++next_) {
            rows_->read(row_);
            if (next_ >= stored.top) unpack(layout, stored, out.image);
        }
        if (next_ == layout.height) rows_.reset();
        return out;
    }

  private:
    void check() {
        const std::unique_ptr<RowSource> rows = open_();
        row_.resize(rows->layout().row_bytes());
        for (int y = 0; y < rows->layout().height; ++y) rows->read(row_);
        rows->finish();
        *checked_ = true;
    }

    // As the decoders of the whole do it.
    void unpack(const RowLayout& layout, const PixelRect& stored, Image& image) const {
        const auto channels = static_cast<std::size_t>(layout.channels),
                   first = static_cast<std::size_t>(stored.left) * channels,
                   count = static_cast<std::size_t>(stored.width()) * channels;
        float* const out = image.pixel(0, next_ - stored.top);
        for (std::size_t i = 0; i < count; ++i) {
            std::uint16_t code = row_[layout.bits == 8 ? first + i : 0];
            if (layout.bits == 16) std::memcpy(&code, &row_[2 * (first + i)], sizeof code);
            out[i] = static_cast<float>(code) / (layout.bits == 8 ? 255.0f : 65535.0f);
            if (layout.inks_upside_down) out[i] = 1 - out[i];
        }
    }

    OpenRows open_;
    std::shared_ptr<std::atomic<bool>> checked_;
    std::unique_ptr<RowSource> rows_;
    std::vector<std::uint8_t> row_;
    int next_ = 0;
};

std::unique_ptr<RegionReader> spoolable(const std::string& path, const ReadImageOptions& options,
                                        const OpenRows& open, const char* format) {
    const std::unique_ptr<RowSource> rows = open();
    const RowLayout& layout = rows->layout();
    PictureHeader header;
    header.width = layout.width;
    header.height = layout.height;
    header.block_width = layout.width;
    header.block_height = layout.height;
    header.zero_pixel = zero_pixel(layout);
    header.access = RegionAccess::kSpool;
    header.by_rows = true;
    header.why = cat("it is a ", format);
    header.decode_bytes = static_cast<std::uint64_t>(layout.width) *
                          static_cast<std::uint64_t>(layout.height) *
                          static_cast<std::uint64_t>(layout.channels) * sizeof(float);
    return open_decoded(path, options, std::move(header),
                        [open, checked = std::make_shared<std::atomic<bool>>(false)] {
                            return std::make_unique<RowDecoder>(open, checked);
                        });
}

}  // namespace

std::unique_ptr<RegionReader> open_png_regions(const std::string& path, const ReadImageOptions& options) {
    return spoolable(
        path, options, [path, options] { return open_png_rows(path, options); }, "PNG");
}

std::unique_ptr<RegionReader> open_jpeg_regions(const std::string& path, const ReadImageOptions& options) {
    return spoolable(
        path, options, [path, options] { return open_jpeg_rows(path, options); }, "JPEG");
}

}  // namespace imgmesh
