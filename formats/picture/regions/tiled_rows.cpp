#include "formats/picture/regions/tiled_rows.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <new>

namespace imgmesh {
namespace {

constexpr int kTile = 256;  // pixels a side; the least unit of TIFF is 16
constexpr int kUnit = 16;

int no_warning(TIFF*, void*, const char*, const char*, std::va_list) {
    return 1;
}

}  // namespace

TiledRows::TiledRows(const std::string& path, const RowShape& shape,
                     const std::function<void(TIFF*)>& set_tags)
    : path_(path), shape_(shape), file_(path, /*overwrite=*/true) {
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, this);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), no_warning, this);
    const int own = ::fcntl(file_.descriptor(), F_DUPFD_CLOEXEC, 0);  // libtiff closes it
    if (own < 0) throw failed();
    tiff_.reset(TIFFFdOpenExt(own, "image", "w8", options.get()));
    if (!tiff_) {
        ::close(own);
        throw failed();
    }
    constexpr std::size_t kRowOfTiles = std::size_t{32} << 20;  // bytes
    const std::size_t row_bytes = shape.row_bytes();
    const auto rows = static_cast<int>(std::min<std::size_t>(kRowOfTiles / row_bytes / kUnit, kTile)) * kUnit;
    tile_height_ = std::clamp(rows, kUnit, kTile);
    rows_.resize(static_cast<std::size_t>(tile_height_) * row_bytes);
    TIFF* const t = tiff_.get();
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, shape.width);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, shape.height);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, shape.samples);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, shape.bits);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, shape.planar ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
    TIFFSetField(t, TIFFTAG_TILEWIDTH, kTile);
    TIFFSetField(t, TIFFTAG_TILELENGTH, tile_height_);
    set_tags(t);
}

int TiledRows::on_error(TIFF*, void* self, const char*, const char*, std::va_list) {
    auto& error = static_cast<TiledRows*>(self)->error_;
    if (error.empty()) error = errno != 0 ? std::strerror(errno) : "libtiff fails";
    return 1;
}

Error TiledRows::failed() const {
    return {ErrorKind::kIo, cat(path_, ": cannot write: ", error_)};
}

void TiledRows::write_plane(const std::function<bool(int, std::span<std::uint8_t>)>& read) {
    const std::size_t row_bytes = shape_.row_bytes();
    for (int top = 0; top < shape_.height; top += tile_height_) {
        const int rows = std::min(tile_height_, shape_.height - top);
        bool sound = true;
        for (int y = 0; y < rows; ++y)
            if (!read(top + y, std::span(rows_).subspan(static_cast<std::size_t>(y) * row_bytes, row_bytes)))
                sound = false;
        write_tiles(rows, sound);
    }
}

// Columns of tiles begin at whole bytes, whatever the bits of a pixel are.
void TiledRows::write_tiles(int rows, bool sound) {
    const std::size_t row_bytes = shape_.row_bytes(),
                      tile_bytes =
                          static_cast<std::size_t>(kTile / 8) * static_cast<std::size_t>(shape_.pixel_bits());
    std::vector<std::uint8_t> tile(static_cast<std::size_t>(tile_height_) * tile_bytes);
    const auto size = static_cast<tmsize_t>(tile.size());
    for (std::size_t from = 0; from < row_bytes; from += tile_bytes) {
        if (!sound) {
            ++index_;  // left out
            continue;
        }
        empty_ = false;
        const std::size_t count = std::min(tile_bytes, row_bytes - from);
        std::ranges::fill(tile, std::uint8_t{0});
        for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y)
            std::memcpy(&tile[y * tile_bytes], &rows_[y * row_bytes + from], count);
        if (TIFFWriteEncodedTile(tiff_.get(), index_++, tile.data(), size) != size) throw failed();
    }
}

void TiledRows::finish() {
    if (TIFFWriteDirectory(tiff_.get()) != 1) throw failed();
    tiff_.reset();
    if (!error_.empty()) throw failed();
    file_.commit();
}

}  // namespace imgmesh
