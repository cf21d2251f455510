// A TIFF in strips that is rewritten by rows, or read by rows, has the samples that it had.
#include <doctest/doctest.h>

#include <cstring>

#include "formats/picture/spool.h"
#include "libcore/base/error.h"
#include "tests/support/region_checks.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiff_writer.h"

using namespace imgmesh;

namespace {

constexpr int kWidth = 301, kHeight = 270;  // more than a tile each way

// Repeats in the picture, so that compression finds something; the last bits are noise.
std::function<std::uint64_t(int, int, int)> codes_of(int bits) {
    return [bits](int x, int y, int s) { return noise(x % 37, y % 5, s, bits) ^ noise(x, y, s, 1); };
}

struct Copies {
    TemporaryFolder folder;
    std::string path = folder / "s.tif", copy = folder / "c.tif";

    void check(const TiffShape& shape, const std::function<void(TIFF*)>& change = {}) const {
        INFO(label(shape));
        TiffShape sized = shape;
        sized.width = kWidth;
        sized.height = kHeight;
        if (sized.rows == 0) sized.rows = kHeight;
        // All numbers of so few bits are finite.
        const bool floats = shape.format == SAMPLEFORMAT_IEEEFP;
        write_tiff(path, sized, codes_of(floats ? shape.bits - 3 : shape.bits), change);
        spool_picture(path, copy);
        check_copy(path, copy, 190);
    }
};

}  // namespace

TEST_CASE("spool tiff: depths, planes, byte orders, compressions, one strip and many") {
    const Copies copies;
    for (const int bits : {1, 2, 4, 8, 12, 16, 24, 32, 64})
        for (const int samples : {1, 3, 4})
            for (const bool planar : {false, true}) {
                TiffShape shape{.samples = samples, .bits = bits, .planar = planar, .rows = 0};
                if (samples >= 3) shape.photometric = PHOTOMETRIC_RGB;
                if (samples == 4) shape.extras = {EXTRASAMPLE_ASSOCALPHA};
                for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
                    if (planar && samples == 1) continue;
                    shape.compression = compression;
                    shape.mode = bits % 16 == 0 ? "wb" : compression == COMPRESSION_LZW ? "w8" : "wl";
                    copies.check(shape);
                }
            }
    copies.check(
        {.samples = 3, .photometric = PHOTOMETRIC_RGB, .compression = COMPRESSION_PACKBITS, .rows = 100});
}

TEST_CASE("spool tiff: floats and predictors, signed, inverted, ink, palettes, YCbCr, JPEG, fax, turned") {
    const Copies copies;
    for (const int bits : {16, 32, 64})
        copies.check({.bits = bits, .format = SAMPLEFORMAT_IEEEFP, .rows = 0});
    const auto predicted = [](int predictor) {
        return [predictor](TIFF* t) { TIFFSetField(t, TIFFTAG_PREDICTOR, predictor); };
    };
    for (const bool planar : {false, true})
        for (const char* mode : {"wl", "wb"}) {
            TiffShape shape{
                .samples = 3, .photometric = PHOTOMETRIC_RGB, .planar = planar, .rows = 0, .mode = mode};
            for (const int compression : {COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_ZSTD}) {
                shape.compression = compression;
                shape.format = SAMPLEFORMAT_UINT;
                for (const int bits : {8, 16, 32, 64}) {
                    shape.bits = bits;
                    copies.check(shape, predicted(PREDICTOR_HORIZONTAL));
                }
                shape.format = SAMPLEFORMAT_IEEEFP;
                for (const int bits : {16, 24, 32, 64}) {
                    if (shape.mode[1] == 'b') continue;  // libtiff does not read what it writes
                    shape.bits = bits;
                    copies.check(shape, predicted(PREDICTOR_FLOATINGPOINT));
                }
            }
        }
    copies.check({.bits = 16, .format = SAMPLEFORMAT_INT, .rows = 0});
    copies.check({.photometric = PHOTOMETRIC_MINISWHITE, .rows = 0});
    copies.check({.samples = 4, .photometric = PHOTOMETRIC_SEPARATED, .rows = 0});
    std::vector<std::uint16_t> map(256);
    for (std::size_t i = 0; i < map.size(); ++i) map[i] = static_cast<std::uint16_t>(i * 255 + 7);
    copies.check({.photometric = PHOTOMETRIC_PALETTE, .rows = 0},
                 [&](TIFF* t) { TIFFSetField(t, TIFFTAG_COLORMAP, map.data(), map.data(), map.data()); });
    const float weights[] = {0.3f, 0.6f, 0.1f}, reference[] = {16, 235, 128, 240, 128, 240};
    copies.check({.samples = 3, .photometric = PHOTOMETRIC_YCBCR, .rows = 0}, [&](TIFF* t) {
        TIFFSetField(t, TIFFTAG_YCBCRSUBSAMPLING, 1, 1);
        TIFFSetField(t, TIFFTAG_YCBCRCOEFFICIENTS, weights);
        TIFFSetField(t, TIFFTAG_REFERENCEBLACKWHITE, reference);
    });
    for (const int samples : {1, 3})
        copies.check({.samples = samples,
                      .photometric = samples == 3 ? PHOTOMETRIC_YCBCR : PHOTOMETRIC_MINISBLACK,
                      .compression = COMPRESSION_JPEG,
                      .rows = 0},
                     [](TIFF* t) { TIFFSetField(t, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB); });
    copies.check({.bits = 1, .compression = COMPRESSION_CCITTFAX4, .rows = 0});
    for (int orientation = 1; orientation <= 8; ++orientation)
        copies.check({.rows = 0}, [&](TIFF* t) { TIFFSetField(t, TIFFTAG_ORIENTATION, orientation); });
}

TEST_CASE("spool tiff: what a file says of its colours and of pixels without data") {
    const Copies copies;
    const float white[] = {0.3127f, 0.3290f}, wide[] = {0.70f, 0.29f, 0.17f, 0.79f, 0.13f, 0.05f};
    const TiffShape shape{.samples = 3, .photometric = PHOTOMETRIC_RGB, .rows = 0};
    copies.check(shape, [&](TIFF* t) {
        TIFFSetField(t, TIFFTAG_WHITEPOINT, white);
        TIFFSetField(t, TIFFTAG_PRIMARYCHROMATICITIES, wide);
    });
    TIFFFieldInfo field{42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALNoData")};
    copies.check({.bits = 2, .rows = 0}, [&](TIFF* t) {
        TIFFMergeFieldInfo(t, &field, 1);
        TIFFSetField(t, 42113, "3");
    });
}

TEST_CASE("spool tiff: where a strip is broken the copy is, and only there") {
    const Copies copies;
    TiffShape shape{
        .width = kWidth, .height = 600, .samples = 3, .photometric = PHOTOMETRIC_RGB, .rows = 300};
    shape.compression = COMPRESSION_ADOBE_DEFLATE;
    TIFFFieldInfo field{42113, -1, -1, TIFF_ASCII, FIELD_CUSTOM, 1, 0, const_cast<char*>("GDALNoData")};
    for (const bool nodata : {false, true})
        for (const bool checksum : {false, true}) {
            // A tile that is left out would be one without data.
            write_tiff(copies.path, shape, codes_of(8), [&](TIFF* t) {
                if (!nodata) return;
                TIFFMergeFieldInfo(t, &field, 1);
                TIFFSetField(t, 42113, "0");
            });
            std::uint64_t at = 0, size = 0;
            {
                const TiffHandle tiff(TIFFOpen(copies.path.c_str(), "r"), TIFFClose);
                at = TIFFGetStrileOffset(tiff.get(), 0);
                size = TIFFGetStrileByteCount(tiff.get(), 0);
            }
            const ReadImage whole = read_image_file(copies.path);
            std::vector<std::uint8_t> bytes = load(copies.path);
            if (checksum)
                bytes[at + size - 1] ^= 1;
            else
                for (std::size_t i = 0; i < 16; ++i) bytes[at + size * 95 / 100 + i] = 0xFF;
            save(copies.path, bytes);
            const std::vector<std::string> warnings = spool_picture(copies.path, copies.copy);
            REQUIRE(!warnings.empty());
            CHECK_MESSAGE((warnings.back().find("not all of it can be read") == 0), warnings.back());
            const RegionSource source(copies.copy);
            const PixelRect sound{0, 512, kWidth, 600};
            check_part(source.read_region(sound), whole, sound);
            // What is above the damage may be wrong already.
            CHECK_THROWS_AS((void)source.read({0, 0, 10, 10}), Error);
            CHECK_THROWS_AS((void)source.read({290, 510, 300, 511}), Error);
        }
}

TEST_CASE("spool tiff: large strips are read by rows, from the top without holding the picture") {
    const TemporaryFolder folder;
    const std::string path = folder / "l.tif";
    constexpr int kSide = 4300;
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_CCITTFAX4, COMPRESSION_ADOBE_DEFLATE}) {
        write_tiff(path,
                   {.width = kSide, .height = kSide, .bits = 1, .compression = compression, .rows = kSide},
                   [](int x, int y, int) { return static_cast<std::uint64_t>((x / 100 + y / 70) % 2); });
        const RegionSource source(path);
        // Rows that are not packed have places. libtiff gives one such strip as many small ones.
        const bool plain = compression == COMPRESSION_NONE;
        CHECK(source.facts().access == (plain ? RegionAccess::kDirect : RegionAccess::kSpool));
        CHECK(source.facts().why.find(plain ? "" : "strips of 4300 rows") != std::string::npos);
        CHECK(source.read_bytes(16, 16) < 100000);
        const auto check = [&](const PixelRect& r) {
            const Image part = source.read(r);
            int wrong = 0;
            for (int y = r.top; y < r.bottom; ++y)
                for (int x = r.left; x < r.right; ++x)
                    wrong +=
                        part.pixel(x - r.left, y - r.top)[0] != static_cast<float>((x / 100 + y / 70) % 2);
            CHECK(wrong == 0);
        };
        check({3, 100, 1000, 110});
        check({2000, 4000, 4300, 4100});
        check({0, 0, 300, 300});  // back: it may be held now
        // With limits of a region it may not.
        ReadImageOptions small;
        small.limits.max_pixels = 1000000;
        const RegionSource never(path, small);
        (void)never.read({0, 4000, 10, 4010});
        CHECK(never.read({130, 30, 131, 31}).data == std::vector<float>{1});
    }
}
