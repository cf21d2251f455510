#include "formats/picture/spool.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdarg>
#include <cstring>
#include <new>

#include "formats/files/atomic_file.h"
#include "formats/files/random_file.h"
#include "formats/picture/decode/spool_tag.h"
#include "formats/picture/regions/row_source.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr int kTile = 256;  // pixels a side; the least unit of TIFF is 16
constexpr int kUnit = 16;

std::unique_ptr<RowSource> open_rows(const std::string& path, const ReadImageOptions& options) {
    constexpr std::size_t kStart = std::size_t{1} << 16;
    switch (probe_picture(path, RandomFile(path).bytes_at(0, kStart)).format) {
        case PictureFormat::kPng:
            return open_png_rows(path, options);
        case PictureFormat::kJpeg:
            return open_jpeg_rows(path, options);
        default:
            throw Error(ErrorKind::kUnsupported, cat(path, ": only PNG and JPEG are rewritten by rows"));
    }
}

class TiledWriter {
  public:
    TiledWriter(const std::string& path, const RowLayout& layout)
        : path_(path), layout_(layout), file_(path, /*overwrite=*/true) {
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
        if (!options) throw std::bad_alloc();
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, this);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, this);
        const int own = ::fcntl(file_.descriptor(), F_DUPFD_CLOEXEC, 0);  // libtiff closes it
        if (own < 0) throw failed();
        tiff_.reset(TIFFFdOpenExt(own, "image", "w8", options.get()));
        if (!tiff_) {
            ::close(own);
            throw failed();
        }
        constexpr std::size_t kRowOfTiles = std::size_t{32} << 20;  // bytes
        const auto rows = static_cast<int>(kRowOfTiles / layout.row_bytes() / kUnit) * kUnit;
        tile_height_ = std::clamp(rows, kUnit, kTile);
        rows_.resize(static_cast<std::size_t>(tile_height_) * layout.row_bytes());
        set_tags();
    }

    void write(RowSource& source) {
        const std::size_t row_bytes = layout_.row_bytes();
        for (int top = 0; top < layout_.height; top += tile_height_) {
            const int rows = std::min(tile_height_, layout_.height - top);
            for (int y = 0; y < rows; ++y)
                source.read(std::span(rows_).subspan(static_cast<std::size_t>(y) * row_bytes, row_bytes));
            write_tiles(rows);
        }
    }

    void finish() {
        if (TIFFWriteDirectory(tiff_.get()) != 1) throw failed();
        tiff_.reset();
        if (!error_.empty()) throw failed();
        file_.commit();
    }

  private:
    struct Close {
        void operator()(TIFF* tiff) const { TIFFClose(tiff); }
    };

    static int on_error(TIFF*, void* self, const char*, const char*, std::va_list) {
        auto& error = static_cast<TiledWriter*>(self)->error_;
        if (error.empty()) error = errno != 0 ? std::strerror(errno) : "libtiff fails";
        return 1;
    }
    static int on_warning(TIFF*, void*, const char*, const char*, std::va_list) { return 1; }

    Error failed() const { return {ErrorKind::kIo, cat(path_, ": cannot write: ", error_)}; }

    void set_tags() {
        TIFF* const t = tiff_.get();
        const bool inks = layout_.color.inks;
        const int color = inks ? 4 : layout_.channels < 3 ? 1 : 3;
        TIFFFieldInfo field = {kSpoolTag,    -3, -3, TIFF_UNDEFINED,
                               FIELD_CUSTOM, 1,  1,  const_cast<char*>("ImgmeshSpool")};
        TIFFMergeFieldInfo(t, &field, 1);
        TIFFSetField(t, TIFFTAG_IMAGEWIDTH, layout_.width);
        TIFFSetField(t, TIFFTAG_IMAGELENGTH, layout_.height);
        TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, layout_.channels);
        TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, layout_.bits);
        TIFFSetField(t, TIFFTAG_PHOTOMETRIC,
                     inks         ? PHOTOMETRIC_SEPARATED
                     : color == 3 ? PHOTOMETRIC_RGB
                                  : PHOTOMETRIC_MINISBLACK);
        TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
        TIFFSetField(t, TIFFTAG_TILEWIDTH, kTile);
        TIFFSetField(t, TIFFTAG_TILELENGTH, tile_height_);
        const std::uint16_t alpha = EXTRASAMPLE_UNASSALPHA;
        if (layout_.channels > color) TIFFSetField(t, TIFFTAG_EXTRASAMPLES, 1, &alpha);
        if (layout_.orientation > 0) TIFFSetField(t, TIFFTAG_ORIENTATION, layout_.orientation);
        const std::vector<std::uint8_t> info = spool_tag({layout_.color, layout_.inks_upside_down});
        TIFFSetField(t, kSpoolTag, static_cast<std::uint32_t>(info.size()), info.data());
    }

    void write_tiles(int rows) {
        const std::size_t row_bytes = layout_.row_bytes(),
                          pixel = row_bytes / static_cast<std::size_t>(layout_.width);
        std::vector<std::uint8_t> tile(static_cast<std::size_t>(kTile) * pixel *
                                       static_cast<std::size_t>(tile_height_));
        for (int x = 0; x < layout_.width; x += kTile) {
            const auto columns = static_cast<std::size_t>(std::min(kTile, layout_.width - x));
            std::ranges::fill(tile, std::uint8_t{0});
            for (std::size_t y = 0; y < static_cast<std::size_t>(rows); ++y)
                std::memcpy(&tile[y * kTile * pixel],
                            &rows_[y * row_bytes + static_cast<std::size_t>(x) * pixel], columns * pixel);
            const auto size = static_cast<tmsize_t>(tile.size());
            if (TIFFWriteEncodedTile(tiff_.get(), index_++, tile.data(), size) != size) throw failed();
        }
    }

    std::string path_;
    const RowLayout& layout_;
    AtomicFile file_;
    std::string error_;
    std::unique_ptr<TIFF, Close> tiff_;
    int tile_height_ = kTile;
    std::uint32_t index_ = 0;
    std::vector<std::uint8_t> rows_;
};

}  // namespace

std::vector<std::string> spool_picture(const std::string& path, const std::string& out_path,
                                       const ReadImageOptions& options) {
    const std::unique_ptr<RowSource> source = open_rows(path, options);
    TiledWriter writer(out_path, source->layout());
    writer.write(*source);
    std::vector<std::string> warnings = source->layout().warnings;
    for (std::string& warning : source->finish()) warnings.push_back(std::move(warning));
    writer.finish();
    return warnings;
}

DecodedPicture zero_pixel(const RowLayout& layout) {
    DecodedPicture out;
    out.image = make_image(1, 1, layout.channels);
    out.image.sample_type = layout.bits == 16 ? SampleType::kUint16 : SampleType::kUint8;
    out.orientation = layout.orientation;
    out.color = layout.color;
    if (layout.color.inks) out.image.channel_names = {"C", "M", "Y", "K"};
    out.warnings = layout.warnings;
    return out;
}

}  // namespace imgmesh
