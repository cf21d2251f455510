// What TIFF's ways of storing colours become.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "formats/picture/image_io.h"
#include "libcore/image/color.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiff_writer.h"

using namespace imgmesh;
using Names = std::vector<std::string>;

TEST_CASE("tiff: CMYK of many depths, with alpha and other channels, as RGB") {
    const TemporaryFolder folder;
    for (const int bits : {1, 2, 4, 8, 12, 16, 24, 32})
        for (const bool planar : {false, true})
            for (const bool tiled : {false, true})
                for (const int extras : {0, 1, 2}) {
                    TiffShape shape{.samples = 4 + extras,
                                    .bits = bits,
                                    .photometric = PHOTOMETRIC_SEPARATED,
                                    .planar = planar,
                                    .tiled = tiled};
                    if (extras > 0) shape.extras = {EXTRASAMPLE_UNASSALPHA};
                    if (extras > 1) shape.extras.push_back(EXTRASAMPLE_UNSPECIFIED);
                    INFO(label(shape));
                    write_tiff(folder / "k.tif", shape,
                               [&](int x, int y, int s) { return noise(x, y, s, bits); });
                    const Image image = read_image(folder / "k.tif");
                    Names names = {"R", "G", "B"};
                    if (extras > 0) names.emplace_back("A");
                    if (extras > 1) names.emplace_back("channel5");
                    CHECK(image.channel_names == names);
                    const double largest = std::ldexp(1.0, bits) - 1;
                    check_samples(
                        image,
                        [&](int x, int y, int c) {
                            const auto part = [&](int s) {
                                return static_cast<double>(noise(x, y, s, bits)) / largest;
                            };
                            return c < 3 ? (1 - part(c)) * (1 - part(3)) : part(c + 1);
                        },
                        1e-6);
                }
    TiffShape inks{.samples = 5, .photometric = PHOTOMETRIC_SEPARATED};
    write_tiff(
        folder / "n.tif", inks, [](int, int, int) -> std::uint64_t { return 9; },
        [](TIFF* tiff) {
            TIFFSetField(tiff, TIFFTAG_INKSET, INKSET_MULTIINK);
            TIFFSetField(tiff, TIFFTAG_NUMBEROFINKS, 5);
        });
    std::string text;
    CHECK(error_of([&] { read_image(folder / "n.tif"); }, &text) == ErrorKind::kUnsupported);
    CHECK_MESSAGE((text.find("inks") != std::string::npos), text);
}

TEST_CASE("tiff: inverted grey and masks") {
    const TemporaryFolder folder;
    for (const int bits : {1, 4, 8, 16})
        for (const int photometric : {PHOTOMETRIC_MINISWHITE, PHOTOMETRIC_MASK}) {
            const TiffShape shape{.bits = bits, .photometric = photometric};
            INFO(label(shape));
            write_tiff(folder / "g.tif", shape, [&](int x, int y, int s) { return noise(x, y, s, bits); });
            const ReadImage read = read_image_file(folder / "g.tif");
            CHECK(read.image.channel_names == Names{"Y"});
            check_samples(read.image, [&](int x, int y, int s) {
                const double part = static_cast<double>(noise(x, y, s, bits)) / (std::ldexp(1.0, bits) - 1);
                return photometric == PHOTOMETRIC_MASK ? part : 1 - part;
            });
            CHECK(read.warnings.size() == (photometric == PHOTOMETRIC_MASK ? 1 : 0));  // the only page
        }
}

TEST_CASE("tiff: palettes of 1 to 16 bits, of 16-bit entries and of the 8-bit ones of old writers") {
    const TemporaryFolder folder;
    enum Entries { kWide, kRepeated, kShifted, kLow };
    for (const int bits : {1, 2, 4, 8, 16})
        for (const bool tiled : {false, true})
            for (const Entries entries : {kWide, kRepeated, kShifted, kLow}) {
                const TiffShape shape{.bits = bits, .photometric = PHOTOMETRIC_PALETTE, .tiled = tiled};
                INFO(label(shape) << " entries " << static_cast<int>(entries));
                const std::size_t count = std::size_t{1} << bits;
                std::vector<std::vector<std::uint16_t>> maps(3, std::vector<std::uint16_t>(count));
                std::vector<std::vector<double>> truth(3, std::vector<double>(count));
                for (std::size_t c = 0; c < 3; ++c)
                    for (std::size_t i = 0; i < count; ++i) {
                        const auto wide = static_cast<std::uint16_t>(
                            noise(static_cast<int>(i), 5, static_cast<int>(c), 16));
                        const int byte = wide >> 8;
                        maps[c][i] = static_cast<std::uint16_t>(entries == kWide       ? wide
                                                                : entries == kRepeated ? byte * 257
                                                                : entries == kShifted  ? byte * 256
                                                                                       : byte);
                        truth[c][i] = entries == kWide ? wide / 65535.0 : byte / 255.0;
                    }
                write_tiff(
                    folder / "p.tif", shape, [&](int x, int y, int s) { return noise(x, y, s, bits); },
                    [&](TIFF* tiff) {
                        TIFFSetField(tiff, TIFFTAG_COLORMAP, maps[0].data(), maps[1].data(), maps[2].data());
                    });
                const Image image = read_image(folder / "p.tif");
                CHECK(image.channel_names == Names{"R", "G", "B"});
                CHECK(image.sample_type == (entries == kWide ? SampleType::kUint16 : SampleType::kUint8));
                check_samples(image, [&](int x, int y, int c) {
                    return truth[static_cast<std::size_t>(c)][noise(x, y, 0, bits)];
                });
            }
}

// TIFF 6.0, section 21: four Y, then Cb and Cr; Y = 0.299 R + 0.587 G + 0.114 B.
TEST_CASE("tiff: YCbCr without JPEG, subsampled or not, in strips and tiles") {
    const TemporaryFolder folder;
    const auto rgb = [](double y, double cb, double cr) {
        const double b = (cb - 128) / 127 * 127 / 255, r = (cr - 128) / 127 * 127 / 255;
        const double red = y / 255 + r * 1.402, blue = y / 255 + b * 1.772;
        return std::array<double, 3>{red, (y / 255 - 0.299 * red - 0.114 * blue) / 0.587, blue};
    };
    const auto luma = [](int x, int y) { return 60 + 3 * x + 2 * y; };
    for (const int wide : {1, 2, 4})
        for (const int high : {1, 2, 4})
            for (const bool tiled : {false, true})
                for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW}) {
                    if (high > wide) continue;  // which the standard excludes
                    INFO(wide << " x " << high << " tiled " << tiled << " compression " << compression);
                    const auto tiff = create_tiff(folder / "y.tif");
                    const int width = 37, height = 21, side = 16, rows = 8;
                    TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, width);
                    TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, height);
                    TIFFSetField(tiff.get(), TIFFTAG_SAMPLESPERPIXEL, 3);
                    TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 8);
                    TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_YCBCR);
                    TIFFSetField(tiff.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
                    TIFFSetField(tiff.get(), TIFFTAG_COMPRESSION, compression);
                    TIFFSetField(tiff.get(), TIFFTAG_YCBCRSUBSAMPLING, wide, high);
                    const float range[] = {0, 255, 128, 255, 128, 255};
                    TIFFSetField(tiff.get(), TIFFTAG_REFERENCEBLACKWHITE, range);
                    if (tiled) {
                        TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, side);
                        TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, side);
                    } else {
                        TIFFSetField(tiff.get(), TIFFTAG_ROWSPERSTRIP, rows);
                    }
                    const auto chroma = [&](int x, int y) {
                        return 110 + (x / wide) % 7 * 4 + (y / high) % 5;
                    };
                    std::uint32_t index = 0;
                    const int block_width = tiled ? side : width, block_height = tiled ? side : rows;
                    for (int top = 0; top < height; top += block_height)
                        for (int left = 0; left < width; left += block_width, ++index) {
                            std::vector<std::uint8_t> block;
                            const int bottom = tiled ? top + side : std::min(height, top + rows);
                            for (int y = top; y < bottom; y += high)
                                for (int x = left; x < left + block_width; x += wide) {
                                    for (int v = 0; v < high; ++v)
                                        for (int u = 0; u < wide; ++u)
                                            block.push_back(static_cast<std::uint8_t>(luma(x + u, y + v)));
                                    block.push_back(static_cast<std::uint8_t>(chroma(x, y)));
                                    block.push_back(static_cast<std::uint8_t>(chroma(x, y) + 20));
                                }
                            const auto size = static_cast<tmsize_t>(block.size());
                            REQUIRE((tiled ? TIFFWriteEncodedTile(tiff.get(), index, block.data(), size)
                                           : TIFFWriteEncodedStrip(tiff.get(), index, block.data(), size)) ==
                                    size);
                        }
                    REQUIRE(TIFFFlush(tiff.get()) == 1);
                    const Image image = read_image(folder / "y.tif");
                    check_samples(
                        image,
                        [&](int x, int y, int c) {
                            return rgb(luma(x, y), chroma(x, y),
                                       chroma(x, y) + 20)[static_cast<std::size_t>(c)];
                        },
                        1e-5);
                }
}

TEST_CASE("tiff: JPEG inside, as RGB, YCbCr, grey and CMYK, in strips and tiles") {
    const TemporaryFolder folder;
    const auto code = [](int x, int y, int s) -> std::uint64_t {
        return static_cast<std::uint64_t>(40 + 2 * x + 2 * y + 20 * s);
    };
    for (const int photometric :
         {PHOTOMETRIC_RGB, PHOTOMETRIC_YCBCR, PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_SEPARATED})
        for (const bool tiled : {false, true}) {
            const int samples = photometric == PHOTOMETRIC_MINISBLACK  ? 1
                                : photometric == PHOTOMETRIC_SEPARATED ? 4
                                                                       : 3;
            TiffShape shape{.width = 40,
                            .height = 32,
                            .samples = samples,
                            .photometric = photometric,
                            .tiled = tiled,
                            .compression = COMPRESSION_JPEG,
                            .rows = 16};
            INFO(label(shape));
            const auto tiff = create_tiff(folder / "j.tif");
            write_tiff_page(tiff.get(), shape, code, [&](TIFF* t) {
                TIFFSetField(t, TIFFTAG_JPEGQUALITY, 98);
                if (photometric == PHOTOMETRIC_YCBCR) {
                    TIFFSetField(t, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
                    TIFFSetField(t, TIFFTAG_YCBCRSUBSAMPLING, 1, 1);
                }
            });
            TIFFFlush(tiff.get());
            check_samples(
                read_image(folder / "j.tif"),
                [&](int x, int y, int c) {
                    const auto part = [&](int s) { return static_cast<double>(code(x, y, s)) / 255; };
                    return samples == 4 ? (1 - part(c)) * (1 - part(3)) : part(c);
                },
                0.03);
        }
}

// L* 50 without chroma is the grey of linear 0.1842, under any white.
TEST_CASE("tiff: L*a*b* of 8 and 16 bits, and LogLuv") {
    const TemporaryFolder folder;
    for (const int bits : {8, 16})
        for (const int photometric : {PHOTOMETRIC_CIELAB, PHOTOMETRIC_ICCLAB}) {
            const TiffShape shape{.samples = 3, .bits = bits, .photometric = photometric};
            INFO(label(shape));
            const bool icc = photometric == PHOTOMETRIC_ICCLAB;
            // L* 0 to 100 along x; a* and b* 0, but in the last row a* = 40, b* = -30.
            const auto lab = [](int x, int y, int s) -> double {
                return s == 0 ? x * 100.0 / 36 : y < 20 ? 0 : s == 1 ? 40 : -30;
            };
            write_tiff(folder / "l.tif", shape, [&](int x, int y, int s) {
                const double v = lab(x, y, s), unit = bits == 8 ? 1 : 256;
                const double largest = bits == 8 ? 255 : icc ? 65280 : 65535;
                const auto c = static_cast<std::int64_t>(
                    std::lround(s == 0 ? v / 100 * largest : (v + (icc ? 128 : 0)) * unit));
                return static_cast<std::uint64_t>(c) & ((std::uint64_t{1} << bits) - 1);
            });
            const Image image = read_image(folder / "l.tif");
            CHECK(image.color_space == ColorSpace::kSrgb);
            for (int x = 0; x < 37; ++x) {
                const float* p = image.pixel(x, 3);
                const Vec3f luv =
                    luv_from_linear(linear_from_encoded(ColorSpace::kSrgb, Vec3f(p[0], p[1], p[2])));
                CHECK(std::abs(static_cast<double>(luv[0]) - x * 100.0 / 36) < 0.25);
                CHECK(std::abs(luv[1]) + std::abs(luv[2]) < 0.2f);
            }
            // Little CMS converts Lab (50.2, 40, -30) to sRGB 166, 92, 172.
            const float* p = image.pixel(18, 20);
            CHECK(p[0] * 255 == doctest::Approx(166).epsilon(0.01));
            CHECK(p[1] * 255 == doctest::Approx(92).epsilon(0.02));
            CHECK(p[2] * 255 == doctest::Approx(172).epsilon(0.01));
        }
    for (const int compression : {COMPRESSION_SGILOG, COMPRESSION_SGILOG24}) {
        TiffShape shape{.samples = 3,
                        .bits = 32,
                        .photometric = PHOTOMETRIC_LOGLUV,
                        .format = SAMPLEFORMAT_IEEEFP,
                        .compression = compression};
        write_tiff(
            folder / "v.tif", shape,
            [](int x, int, int) -> std::uint64_t {
                return std::bit_cast<std::uint32_t>(0.5f + static_cast<float>(x));
            },
            [](TIFF* t) { TIFFSetField(t, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT); });
        const Image image = read_image(folder / "v.tif");
        CHECK(image.color_space == ColorSpace::kLinear);
        for (int c = 0; c < 3; ++c) CHECK(image.pixel(10, 2)[c] == doctest::Approx(10.5).epsilon(0.03));
    }
}
