// Regions of TIFF files: of the blocks that they touch, and what the whole image has there.
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cstring>
#include <string>

#include "formats/picture/region_source.h"
#include "libcore/base/error.h"
#include "tests/support/icc_bytes.h"
#include "tests/support/region_checks.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiff_writer.h"

using namespace imgmesh;

namespace {

constexpr int kTagNoData = 42113;

std::function<std::uint64_t(int, int, int)> noise_of(int bits) {
    return [bits](int x, int y, int s) { return noise(x, y, s, bits); };
}

bool names(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// The profile of a wide space that is none of ours.
std::vector<std::uint8_t> foreign_profile(double gamma) {
    const cmsCIExyY white{0.3127, 0.3290, 1};
    const cmsCIExyYTRIPLE wide{{0.70, 0.29, 1}, {0.17, 0.79, 1}, {0.13, 0.05, 1}};
    cmsToneCurve* const curve = cmsBuildGamma(nullptr, gamma);
    cmsToneCurve* const curves[] = {curve, curve, curve};
    auto bytes = test::saved(cmsCreateRGBProfile(&white, &wide, curves));
    cmsFreeToneCurve(curve);
    return bytes;
}

}  // namespace

TEST_CASE("tiff regions: every depth, strips and tiles, planes, both byte orders, BigTIFF") {
    const TemporaryFolder folder;
    const std::string path = folder / "d.tif";
    for (const int bits : {1, 2, 3, 4, 7, 8, 12, 16, 24, 32, 64})
        for (const int samples : {1, 2, 3, 4})
            for (const bool planar : {false, true})
                for (const bool tiled : {false, true})
                    for (const char* mode : {"wl", "wb", "w8"}) {
                        TiffShape shape{.samples = samples, .bits = bits, .planar = planar, .tiled = tiled};
                        shape.mode = mode;
                        if (samples >= 3) shape.photometric = PHOTOMETRIC_RGB;
                        if (samples % 2 == 0) shape.extras = {EXTRASAMPLE_UNASSALPHA};
                        INFO(label(shape));
                        write_tiff(path, shape, noise_of(bits));
                        CHECK(RegionSource(path).facts().access == RegionAccess::kDirect);
                        check_regions(path, 11);
                        check_regions(path, 11, {.values = true});
                    }
}

TEST_CASE("tiff regions: floats, signed integers, inverted grey, ink, palettes, YCbCr, associated alpha") {
    const TemporaryFolder folder;
    const std::string path = folder / "c.tif";
    for (const bool tiled : {false, true}) {
        write_tiff(path, {.bits = 16, .format = SAMPLEFORMAT_INT, .tiled = tiled}, noise_of(16));
        check_regions(path, 9);
        write_tiff(path, {.bits = 32, .format = SAMPLEFORMAT_IEEEFP, .tiled = tiled}, noise_of(29));
        check_regions(path, 9);
        write_tiff(path, {.photometric = PHOTOMETRIC_MINISWHITE, .tiled = tiled}, noise_of(8));
        check_regions(path, 9);
        write_tiff(path, {.samples = 4, .photometric = PHOTOMETRIC_SEPARATED, .tiled = tiled}, noise_of(8));
        check_regions(path, 9);
        std::vector<std::uint16_t> map(256);
        for (std::size_t i = 0; i < map.size(); ++i) map[i] = static_cast<std::uint16_t>(i * 255 + 7);
        write_tiff(path, {.photometric = PHOTOMETRIC_PALETTE, .tiled = tiled}, noise_of(8),
                   [&](TIFF* t) { TIFFSetField(t, TIFFTAG_COLORMAP, map.data(), map.data(), map.data()); });
        check_regions(path, 9);
        write_tiff(path, {.samples = 3, .photometric = PHOTOMETRIC_YCBCR, .tiled = tiled}, noise_of(8),
                   [](TIFF* t) { TIFFSetField(t, TIFFTAG_YCBCRSUBSAMPLING, 1, 1); });
        check_regions(path, 9);
        write_tiff(path,
                   {.samples = 4,
                    .photometric = PHOTOMETRIC_RGB,
                    .tiled = tiled,
                    .extras = {EXTRASAMPLE_ASSOCALPHA}},
                   noise_of(8));
        check_regions(path, 9);
        check_regions(path, 9, {.channels = std::vector<std::string>{"R", "A"}});
    }
}

TEST_CASE("tiff regions: compressions, JPEG with subsampled chroma among them") {
    const TemporaryFolder folder;
    const std::string path = folder / "z.tif";
    for (const int compression : {COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS,
                                  COMPRESSION_JPEG, COMPRESSION_ZSTD, COMPRESSION_LZMA})
        for (const bool tiled : {false, true}) {
            TiffShape shape{.width = 70, .height = 50, .samples = 3, .photometric = PHOTOMETRIC_RGB};
            shape.tiled = tiled;
            shape.compression = compression;
            shape.rows = 16;
            const bool jpeg = compression == COMPRESSION_JPEG;
            if (jpeg) shape.photometric = PHOTOMETRIC_YCBCR;
            INFO(label(shape));
            write_tiff(
                path, shape, [](int x, int y, int s) { return noise(x / 4, y / 4, s, 8); },
                [&](TIFF* t) {
                    if (jpeg) TIFFSetField(t, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
                });
            check_regions(path, 23);
        }
}

TEST_CASE("tiff regions: turned as a viewer shows them, with the file's nodata") {
    const TemporaryFolder folder;
    const std::string path = folder / "o.tif";
    TIFFFieldInfo field{kTagNoData, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALNoData")};
    for (int orientation = 1; orientation <= 8; ++orientation)
        write_tiff(
            path, {.tiled = true}, [](int x, int y, int) { return noise(x, y, 0, 2); },
            [&](TIFF* t) {
                TIFFSetField(t, TIFFTAG_ORIENTATION, orientation);
                TIFFMergeFieldInfo(t, &field, 1);
                TIFFSetField(t, kTagNoData, "3");
            }),
            check_regions(path, 7), check_regions(path, 7, {.values = true}),
            check_regions(path, 7, {.values = true, .nodata = 1});
}

TEST_CASE("tiff regions: the space of a foreign profile is that of all pixels, whichever region is read") {
    const TemporaryFolder folder;
    const std::string path = folder / "p.tif";
    const std::vector<std::uint8_t> icc = foreign_profile(1.8);
    for (const int green : {-1, 30}) {  // grey everywhere, and one pixel that sRGB does not hold
        write_tiff(
            path, {.samples = 3, .photometric = PHOTOMETRIC_RGB, .tiled = true},
            [&](int x, int y, int s) -> std::uint64_t {
                return x == green && y == 9 ? s == 1 ? 255 : 0 : noise(x, y, 0, 7);
            },
            [&](TIFF* t) { TIFFSetField(t, TIFFTAG_ICCPROFILE, static_cast<int>(icc.size()), icc.data()); });
        const RegionSource source(path);
        CHECK(source.facts().fits_colors);
        CHECK((source.color_space() == ColorSpace::kSrgb) == (green < 0));
        check_regions(path, 10);
        // Who opens it again passes the space on; it is not looked for then.
        const RegionSource again(path, {.fitting_space = ColorSpace::kAdobeRgb});
        CHECK(again.color_space() == ColorSpace::kAdobeRgb);
        CHECK(again.read({0, 0, 5, 5}).color_space == ColorSpace::kAdobeRgb);
    }
}

TEST_CASE("tiff regions: a broken block is an error where it is read, and named") {
    const TemporaryFolder folder;
    const std::string path = folder / "b.tif";
    TiffShape shape{.width = 64, .height = 32, .tiled = true};
    shape.compression = COMPRESSION_ADOBE_DEFLATE;
    write_tiff(path, shape, noise_of(8));
    std::uint64_t at = 0;
    {
        const TiffHandle tiff(TIFFOpen(path.c_str(), "r"), TIFFClose);
        at = TIFFGetStrileOffset(tiff.get(), 5);
    }
    std::vector<std::uint8_t> bytes = load(path);
    for (std::size_t i = 0; i < 8; ++i) bytes[static_cast<std::size_t>(at) + i] ^= 0xFF;
    save(path, bytes);
    const RegionSource source(path);
    CHECK(failure(source, {0, 0, 64, 16}).empty());
    CHECK(failure(source, {32, 16, 64, 32}).empty());
    CHECK(failure(source, {0, 0, 16, 32}).empty());
    const std::string broken = failure(source, {10, 10, 20, 20});
    INFO(broken);
    CHECK(names(broken, "block 5"));
    CHECK(names(broken, "columns 10 to 19, rows 10 to 19"));
    CHECK(failure(source, {32, 16, 64, 32}).empty());  // others are read afterwards
}

namespace {

// Sets the number of a tag in a BigTIFF of this machine's byte order.
void set_big_tag(std::vector<std::uint8_t>& bytes, std::uint16_t tag, std::uint64_t value) {
    std::uint64_t at = 0, count = 0;
    std::memcpy(&at, &bytes[8], 8);
    std::memcpy(&count, &bytes[at], 8);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t entry = at + 8 + 20 * i;
        std::uint16_t here = 0;
        std::memcpy(&here, &bytes[entry], 2);
        if (here != tag) continue;
        if (value > 65535) bytes[entry + 2] = value >> 32 ? TIFF_LONG8 : TIFF_LONG;
        std::memcpy(&bytes[entry + 12], &value, 8);
        return;
    }
    FAIL("no such tag");
}

std::int64_t peak_memory() {
    rusage use = {};
    getrusage(RUSAGE_SELF, &use);
    return std::int64_t{use.ru_maxrss} << 10;
}

// What opening and reading a corner says.
std::string opening(const std::string& path, const ReadImageOptions& options = {}) {
    try {
        const RegionSource source(path, options);
        (void)source.read({0, 0, 8, 8});
    } catch (const Error& error) {
        return error.what();
    }
    return "";
}

}  // namespace

TEST_CASE("tiff regions: hostile headers are one line, before memory is taken") {
    const TemporaryFolder folder;
    const std::string path = folder / "h.tif";
    TiffShape shape{.width = 64, .height = 64, .samples = 3, .photometric = PHOTOMETRIC_RGB, .tiled = true};
    shape.mode = "w8";
    write_tiff(path, shape, noise_of(8));
    const std::vector<std::uint8_t> good = load(path);
    CHECK(opening(path).empty());
    const std::int64_t before = peak_memory();
    struct Lie {
        std::uint16_t tag;
        std::uint64_t value;
    };
    const auto lying = [&](std::initializer_list<Lie> lies, const ReadImageOptions& options = {}) {
        std::vector<std::uint8_t> bytes = good;
        for (const Lie& lie : lies) set_big_tag(bytes, lie.tag, lie.value);
        save(path, bytes);
        const std::string text = opening(path, options);
        INFO("tag ", lies.begin()->tag, " as ", lies.begin()->value, ": ", text);
        CHECK(!text.empty());
        CHECK(text.find('\n') == std::string::npos);
        return text;
    };
    ReadImageOptions any;
    any.limits.max_pixels_per_byte = 0;
    const std::uint64_t far = std::uint64_t{1} << 62;
    lying({{TIFFTAG_IMAGEWIDTH, 1u << 31}, {TIFFTAG_IMAGELENGTH, 1u << 31}}, any);
    CHECK(names(lying({{TIFFTAG_IMAGEWIDTH, 1u << 24}}, any), "pixels a side"));
    CHECK(names(lying({{TIFFTAG_IMAGEWIDTH, 900000}, {TIFFTAG_IMAGELENGTH, 900000}}), "pixels are read"));
    CHECK(names(lying({{TIFFTAG_IMAGEWIDTH, 900000}, {TIFFTAG_IMAGELENGTH, 900000}}, any),
                "no place is given"));
    lying({{TIFFTAG_TILEWIDTH, 1u << 31}, {TIFFTAG_TILELENGTH, 1u << 31}}, any);
    lying({{TIFFTAG_TILEWIDTH, 65520}, {TIFFTAG_TILELENGTH, 65520}}, any);
    lying({{TIFFTAG_SAMPLESPERPIXEL, 65535}}, any);
    lying({{TIFFTAG_TILEOFFSETS, far}}, any);  // of the table
    lying({{TIFFTAG_TILEBYTECOUNTS, far}}, any);
    // Cut anywhere: an error or, if only what nobody asks for is missing, the pixels.
    for (std::size_t size = 0; size < good.size(); size += 131) {
        save(path, {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
        CHECK((size > good.size() / 2 || !opening(path).empty()));
    }
    CHECK(peak_memory() - before < std::int64_t{64} << 20);
}

TEST_CASE("tiff regions: a million pixels a side, of which nearly all blocks are left out") {
    const TemporaryFolder folder;
    const std::string path = folder / "m.tif";
    constexpr int kSide = 1000000, kTile = 4096;
    {
        const TiffHandle tiff = create_tiff(path, "w8");
        TIFFFieldInfo field{kTagNoData,   -1, -1, TIFF_ASCII,
                            FIELD_CUSTOM, 1,  0,  const_cast<char*>("GDALNoData")};
        TIFFMergeFieldInfo(tiff.get(), &field, 1);
        TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, kSide);
        TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, kSide);
        TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, kTile);
        TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, kTile);
        TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, COMPRESSION_ADOBE_DEFLATE);
        TIFFSetField(tiff.get(), kTagNoData, "0");
        std::vector<std::uint8_t> tile(std::size_t{kTile} * kTile, 9);
        const std::uint32_t last = TIFFNumberOfTiles(tiff.get()) - 1;
        TIFFWriteEncodedTile(tiff.get(), last, tile.data(), static_cast<tmsize_t>(tile.size()));
    }
    ReadImageOptions options;
    options.limits.max_pixels_per_byte = 0;
    const std::int64_t before = peak_memory();
    const RegionSource source(path, options);
    const ReadImage none = source.read_region({500000, 500000, 501025, 501025});
    CHECK(none.data.at(1024, 1024) == 0);
    const ReadImage end = source.read_region({999990, 999990, kSide, kSide});
    CHECK(end.data.empty());
    CHECK(end.image.pixel(9, 9)[0] == 9 / 255.0f);
    CHECK(peak_memory() - before < std::int64_t{64} << 20);
}
