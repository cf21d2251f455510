// Values as a float TIFF, through libtiff.
#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>

#include "formats/picture/encode/picture_encoders.h"
#include "libcore/base/error.h"

namespace imgmesh {
namespace {

constexpr ttag_t kGdalNoData = 42113;

// A file in memory, which libtiff reads and writes anywhere.
struct Bytes {
    std::vector<std::uint8_t> all;
    std::size_t at = 0;

    static Bytes& self(void* file) { return *static_cast<Bytes*>(file); }
    static tmsize_t read(thandle_t file, void* out, tmsize_t count) {
        Bytes& f = self(file);
        const std::size_t left = f.all.size() - std::min(f.at, f.all.size());
        const std::size_t n = std::min(left, static_cast<std::size_t>(count));
        std::memcpy(out, f.all.data() + f.at, n);
        f.at += n;
        return static_cast<tmsize_t>(n);
    }
    static tmsize_t write(thandle_t file, void* from, tmsize_t count) {
        Bytes& f = self(file);
        const auto n = static_cast<std::size_t>(count);
        f.all.resize(std::max(f.all.size(), f.at + n));
        std::memcpy(f.all.data() + f.at, from, n);
        f.at += n;
        return count;
    }
    static toff_t seek(thandle_t file, toff_t to, int whence) {
        Bytes& f = self(file);
        f.at = (whence == SEEK_CUR ? f.at : whence == SEEK_END ? f.all.size() : 0) + to;
        return f.at;
    }
    static int close(thandle_t) { return 0; }
    static toff_t size(thandle_t file) { return self(file).all.size(); }
};

int ignore(TIFF*, void*, const char*, const char*, va_list) {
    return 1;
}

}  // namespace

std::vector<std::uint8_t> encode_tiff_values(const Image& image) {
    const int alpha = image.channel("A"), bands = image.channels - (alpha < 0 ? 0 : 1);
    const auto check = [](bool fine) {
        if (!fine) throw Error(ErrorKind::kBadArgument, "the values cannot be written as TIFF");
    };
    check(bands > 0);
    Bytes bytes;
    const std::unique_ptr<TIFFOpenOptions, void (*)(TIFFOpenOptions*)> options(TIFFOpenOptionsAlloc(),
                                                                               TIFFOpenOptionsFree);
    if (!options) throw std::bad_alloc();
    TIFFOpenOptionsSetErrorHandlerExtR(options.get(), ignore, nullptr);
    TIFFOpenOptionsSetWarningHandlerExtR(options.get(), ignore, nullptr);
    // BigTIFF where 4 GB might not be enough.
    const bool large = image.sample_count() > std::size_t{900} << 20;
    std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(
        TIFFClientOpenExt("image", large ? "w8" : "w", &bytes, Bytes::read, Bytes::write, Bytes::seek,
                          Bytes::close, Bytes::size, nullptr, nullptr, options.get()),
        TIFFClose);
    check(tiff != nullptr);
    TIFF* const t = tiff.get();
    const TIFFFieldInfo field = {kGdalNoData,  -1, -1, TIFF_ASCII,
                                 FIELD_CUSTOM, 1,  0,  const_cast<char*>("GDALNoData")};
    TIFFMergeFieldInfo(t, &field, 1);
    TIFFSetField(t, TIFFTAG_IMAGEWIDTH, image.width);
    TIFFSetField(t, TIFFTAG_IMAGELENGTH, image.height);
    TIFFSetField(t, TIFFTAG_SAMPLESPERPIXEL, bands);
    TIFFSetField(t, TIFFTAG_BITSPERSAMPLE, 32);
    TIFFSetField(t, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_IEEEFP);
    TIFFSetField(t, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
    TIFFSetField(t, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    TIFFSetField(t, TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
    const std::vector<std::uint16_t> extras(static_cast<std::size_t>(bands - 1), EXTRASAMPLE_UNSPECIFIED);
    if (bands > 1) TIFFSetField(t, TIFFTAG_EXTRASAMPLES, bands - 1, extras.data());
    constexpr std::size_t kStrip = 256 << 10;  // bytes
    const std::size_t row = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(bands);
    const int rows = std::clamp(static_cast<int>(kStrip / (row * sizeof(float))), 1, image.height);
    TIFFSetField(t, TIFFTAG_ROWSPERSTRIP, rows);
    if (alpha >= 0) TIFFSetField(t, kGdalNoData, "nan");
    std::vector<float> strip;
    for (int top = 0; top < image.height; top += rows) {
        strip.clear();
        for (int y = top; y < std::min(top + rows, image.height); ++y)
            for (int x = 0; x < image.width; ++x) {
                const float* p = image.pixel(x, y);
                const bool hidden = alpha >= 0 && p[alpha] == 0;
                for (int c = 0; c < image.channels; ++c)
                    if (c != alpha) strip.push_back(hidden ? std::numeric_limits<float>::quiet_NaN() : p[c]);
            }
        const auto size = static_cast<tmsize_t>(strip.size() * sizeof(float));
        check(TIFFWriteEncodedStrip(t, static_cast<std::uint32_t>(top / rows), strip.data(), size) == size);
    }
    check(TIFFWriteDirectory(t) == 1);
    tiff.reset();
    return std::move(bytes.all);
}

}  // namespace imgmesh
