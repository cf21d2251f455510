// Regions of pictures that can only be read from the top: they have to be spooled first.
#include "formats/picture/regions/decoded_regions.h"
#include "formats/picture/regions/row_source.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

std::unique_ptr<RegionReader> spoolable(const std::string& path, const ReadImageOptions& options,
                                        const RowLayout& layout, const char* format) {
    PictureHeader header;
    header.width = layout.width;
    header.height = layout.height;
    header.block_width = layout.width;
    header.block_height = layout.height;
    header.zero_pixel = zero_pixel(layout);
    header.access = RegionAccess::kSpool;
    header.why = cat("it is a ", format);
    header.decode_bytes = static_cast<std::uint64_t>(layout.width) *
                          static_cast<std::uint64_t>(layout.height) *
                          static_cast<std::uint64_t>(layout.channels) * sizeof(float);
    return open_decoded(path, options, std::move(header), {});
}

}  // namespace

std::unique_ptr<RegionReader> open_png_regions(const std::string& path, const ReadImageOptions& options) {
    return spoolable(path, options, open_png_rows(path, options)->layout(), "PNG");
}

std::unique_ptr<RegionReader> open_jpeg_regions(const std::string& path, const ReadImageOptions& options) {
    return spoolable(path, options, open_jpeg_rows(path, options)->layout(), "JPEG");
}

}  // namespace imgmesh
