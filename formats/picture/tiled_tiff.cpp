#include "formats/picture/tiled_tiff.h"

#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <span>
#include <vector>

#include "formats/files/atomic_file.h"
#include "formats/picture/color/icc_profile.h"
#include "formats/picture/encode/picture_encoders.h"
#include "formats/picture/sample_codes.h"
#include "libcore/base/error.h"
#include "libcore/base/index.h"

namespace imgmesh {
namespace {

constexpr int kTile = 256;  // pixels

int ignore(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

std::vector<std::uint8_t> codes_of(const StoredImage& stored) {
    const std::vector<float>& samples = stored.image.data;
    if (stored.type == SampleType::kUint8) return codes8_from_floats(samples);
    const auto bytes = [](const auto& values) {
        const auto* first = reinterpret_cast<const std::uint8_t*>(values.data());
        return std::vector<std::uint8_t>(first, first + values.size() * sizeof(values[0]));
    };
    return stored.type == SampleType::kUint16 ? bytes(codes16_from_floats(samples)) : bytes(samples);
}

}  // namespace

// libtiff's file: it writes anywhere, and reads only what it has written of its header.
struct TiledTiff::Target {
    AtomicFile file;
    std::uint64_t at = 0, size = 0;
    std::string fault = {};  // exceptions do not pass through libtiff

    static Target& self(void* file) { return *static_cast<Target*>(file); }
    static tmsize_t read(thandle_t, void*, tmsize_t) { return 0; }
    static tmsize_t write(thandle_t file, void* from, tmsize_t count) {
        Target& t = self(file);
        try {
            t.file.write_at(t.at, {static_cast<const std::uint8_t*>(from), static_cast<std::size_t>(count)});
        } catch (const Error& error) {
            t.fault = error.what();
            return 0;
        }
        t.at += static_cast<std::uint64_t>(count);
        t.size = std::max(t.size, t.at);
        return count;
    }
    static toff_t seek(thandle_t file, toff_t to, int whence) {
        Target& t = self(file);
        t.at = (whence == SEEK_CUR ? t.at : whence == SEEK_END ? t.size : 0) + to;
        return t.at;
    }
    static int close(thandle_t) { return 0; }
    static toff_t length(thandle_t file) { return self(file).size; }
};

class TiledTiff::File {
  public:
    File(const std::string& path, const PictureShape& shape, std::optional<SampleType> sample_type,
         bool overwrite)
        : path_(path), shape_(shape), asked_(sample_type), target_{AtomicFile(path, overwrite)} {
        Image one = make_image(1, 1, shape.channels);
        one.sample_type = shape.sample_type;
        one.color_space = shape.color_space;
        const StoredImage stored = stored_image(path, one, sample_type);
        const int sample = stored.type == SampleType::kUint8 ? 1 : stored.type == SampleType::kUint16 ? 2 : 4;
        pixel_bytes_ = as_index(sample) * as_index(shape.channels);
        open(stored, sample);
    }

    void put(int x, int y, const Image& block) {
        if (block.channels != shape_.channels || y < top_ || x < 0 || x + block.width > shape_.width ||
            y + block.height > shape_.height)
            throw Error(ErrorKind::kInternal, "a block does not fit into the TIFF");
        const std::vector<std::uint8_t> codes = codes_of(stored_image(path_, block, asked_));
        const std::size_t row = row_bytes(), part = static_cast<std::size_t>(block.width) * pixel_bytes_;
        rows_.resize(std::max(rows_.size(), static_cast<std::size_t>(y - top_ + block.height) * row));
        for (int j = 0; j < block.height; ++j)
            std::memcpy(rows_.data() + static_cast<std::size_t>(y - top_ + j) * row +
                            static_cast<std::size_t>(x) * pixel_bytes_,
                        codes.data() + static_cast<std::size_t>(j) * part, part);
    }

    void complete(int bottom) {
        const int last = bottom >= shape_.height ? shape_.height : bottom / kTile * kTile;
        if (last <= top_) return;
        rows_.resize(std::max(rows_.size(), static_cast<std::size_t>(last - top_) * row_bytes()));
        for (int y = top_; y < last; y += kTile) write_tiles(y);
        rows_.erase(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(
                                                       static_cast<std::size_t>(last - top_) * row_bytes()));
        top_ = last;
    }

    void commit() {
        check(TIFFWriteDirectory(tiff_.get()) == 1);
        tiff_.reset();
        check(target_.fault.empty());
        target_.file.commit();
    }

  private:
    std::size_t row_bytes() const { return static_cast<std::size_t>(shape_.width) * pixel_bytes_; }

    void check(bool fine) const {
        if (!fine)
            throw Error(ErrorKind::kIo,
                        target_.fault.empty() ? cat(path_, ": cannot be written as TIFF") : target_.fault);
    }

    void open(const StoredImage& stored, int sample) {
        const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                                   TIFFOpenOptionsFree);
        if (!options) throw std::bad_alloc();
        TIFFOpenOptionsSetErrorHandlerExtR(options.get(), ignore, nullptr);
        TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
        const bool large = row_bytes() * static_cast<std::size_t>(shape_.height) > std::size_t{2} << 30;
        tiff_.reset(TIFFClientOpenExt("picture", large ? "w8" : "w", &target_, Target::read, Target::write,
                                      Target::seek, Target::close, Target::length, nullptr, nullptr,
                                      options.get()));
        check(tiff_ != nullptr);
        TIFF* const t = tiff_.get();
        const bool has_alpha = shape_.channels % 2 == 0, color = shape_.channels > 2;
        TIFFSetField(t, TIFFTAG_IMAGEWIDTH, shape_.width);
        TIFFSetField(t, TIFFTAG_IMAGELENGTH, shape_.height);
        TIFFSetField(t, TIFFTAG_TILEWIDTH, kTile);
        TIFFSetField(t, TIFFTAG_TILELENGTH, kTile);
        TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, shape_.channels);
        TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 8 * sample);
        TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, sample == 4 ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT);
        TIFFSetField(t, TIFFTAG_PHOTOMETRIC, color ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
        TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
        TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
        TIFFSetField(t, TIFFTAG_PREDICTOR, sample == 4 ? PREDICTOR_FLOATINGPOINT : PREDICTOR_HORIZONTAL);
        const std::uint16_t extra = EXTRASAMPLE_UNASSALPHA;
        if (has_alpha) TIFFSetField(t, TIFFTAG_EXTRASAMPLES, 1, &extra);
        if (sample < 4 && stored.image.color_space != ColorSpace::kSrgb) {
            const std::vector<std::uint8_t> profile = icc_from_color_space(stored.image.color_space);
            TIFFSetField(t, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
        }
    }

    // Writes the row of tiles that begins at row y.
    void write_tiles(int y) {
        const std::size_t row = row_bytes(), tile_row = kTile * pixel_bytes_;
        const int height = std::min(kTile, shape_.height - y);
        std::vector<std::uint8_t> tile;
        for (int x = 0; x < shape_.width; x += kTile) {
            tile.assign(kTile * tile_row, 0);
            const std::size_t width = static_cast<std::size_t>(std::min(kTile, shape_.width - x));
            for (int j = 0; j < height; ++j)
                std::memcpy(tile.data() + static_cast<std::size_t>(j) * tile_row,
                            rows_.data() + static_cast<std::size_t>(y - top_ + j) * row +
                                static_cast<std::size_t>(x) * pixel_bytes_,
                            width * pixel_bytes_);
            const std::uint32_t number = TIFFComputeTile(tiff_.get(), static_cast<std::uint32_t>(x),
                                                         static_cast<std::uint32_t>(y), 0, 0);
            const auto size = static_cast<tmsize_t>(tile.size());
            check(TIFFWriteEncodedTile(tiff_.get(), number, tile.data(), size) == size);
        }
    }

    std::string path_;
    PictureShape shape_;
    std::optional<SampleType> asked_;
    Target target_;
    std::size_t pixel_bytes_ = 0;
    std::vector<std::uint8_t> rows_;  // from row top_ on
    int top_ = 0;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff_{nullptr, TIFFClose};
};

TiledTiff::TiledTiff(const std::string& path, const PictureShape& shape,
                     std::optional<SampleType> sample_type, bool overwrite)
    : file_(std::make_unique<File>(path, shape, sample_type, overwrite)) {}
TiledTiff::~TiledTiff() = default;

void TiledTiff::put(int x, int y, const Image& block) {
    file_->put(x, y, block);
}
void TiledTiff::complete(int bottom) {
    file_->complete(bottom);
}
void TiledTiff::commit() {
    file_->commit();
}

}  // namespace imgmesh
