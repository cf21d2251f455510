// How read_image() reads every way in which TIFF stores samples.
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

TEST_CASE(
    "tiff: unsigned integers of every depth, in strips and tiles, contiguous and planar, both byte orders") {
    const TemporaryFolder folder;
    const std::string path = folder / "d.tif";
    for (const int bits :
         {1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 20, 23, 24, 25, 31, 32, 64})
        for (const int samples : {1, 2, 3, 4})
            for (const bool planar : {false, true})
                for (const bool tiled : {false, true})
                    for (const char* mode : {"wl", "wb", "w8"}) {
                        TiffShape shape{.samples = samples, .bits = bits, .planar = planar, .tiled = tiled};
                        shape.mode = mode;
                        if (samples >= 3) shape.photometric = PHOTOMETRIC_RGB;
                        if (samples % 2 == 0) shape.extras = {EXTRASAMPLE_UNASSALPHA};
                        INFO(label(shape));
                        write_tiff(path, shape, [&](int x, int y, int s) { return noise(x, y, s, bits); });
                        const Image image = read_image(path);
                        REQUIRE(image.channels == samples);
                        REQUIRE(image.width == shape.width);
                        REQUIRE(image.height == shape.height);
                        CHECK(image.channel_names == make_image(1, 1, samples).channel_names);
                        CHECK(image.sample_type == (bits <= 8 ? SampleType::kUint8 : SampleType::kUint16));
                        const double largest = std::ldexp(1.0, bits) - 1;
                        check_samples(image, [&](int x, int y, int s) {
                            return static_cast<double>(noise(x, y, s, bits)) / largest;
                        });
                    }
}

TEST_CASE("tiff: 8 and 16 bits are the nearest floats of code / maximum, as in other formats") {
    const TemporaryFolder folder;
    for (const int bits : {8, 16}) {
        write_tiff(folder / "e.tif", {.width = 256, .bits = bits}, [&](int x, int y, int) {
            return static_cast<std::uint64_t>(x + (bits == 16 ? 256 * y : 0));
        });
        const Image image = read_image(folder / "e.tif");
        const float largest = bits == 8 ? 255 : 65535;
        for (int x = 0; x < 256; ++x)
            CHECK(image.pixel(x, 1)[0] == static_cast<float>(bits == 8 ? x : x + 256) / largest);
    }
}

TEST_CASE("tiff: floats of 16, 24, 32 and 64 bits") {
    const TemporaryFolder folder;
    const std::string path = folder / "f.tif";
    const auto value = [](int x, int y, int s) { return (x - 9) * 0.25 + y * 16 - s; };  // exact in all
    const auto code = [&](int bits, double v) -> std::uint64_t {
        if (bits == 64) return std::bit_cast<std::uint64_t>(v);
        if (bits == 32) return std::bit_cast<std::uint32_t>(static_cast<float>(v));
        if (v == 0) return 0;
        int exponent = 0;
        const double mantissa = std::frexp(std::abs(v), &exponent) * 2 - 1;  // of 1.m * 2^(exponent - 1)
        const int m = bits == 16 ? 10 : 16, e = bits == 16 ? 15 : 63;
        return (v < 0 ? std::uint64_t{1} << (bits - 1) : 0) |
               static_cast<std::uint64_t>(exponent - 1 + e) << m |
               static_cast<std::uint64_t>(std::ldexp(mantissa, m));
    };
    for (const int bits : {16, 24, 32, 64})
        for (const bool planar : {false, true})
            for (const bool tiled : {false, true})
                for (const char* mode : {"wl", "wb"}) {
                    TiffShape shape{.samples = 3,
                                    .bits = bits,
                                    .photometric = PHOTOMETRIC_RGB,
                                    .format = SAMPLEFORMAT_IEEEFP,
                                    .planar = planar,
                                    .tiled = tiled};
                    shape.mode = mode;
                    INFO(label(shape));
                    write_tiff(path, shape, [&](int x, int y, int s) { return code(bits, value(x, y, s)); });
                    const Image image = read_image(path);
                    CHECK(image.color_space == ColorSpace::kLinear);
                    CHECK(image.sample_type == (bits == 16 ? SampleType::kHalf : SampleType::kFloat));
                    check_samples(image, value, 0);
                }
    // The smallest and the largest numbers of 16 and 24 bits.
    for (const auto& [bits, bit_pattern, expected] : {std::tuple(16, 1u, std::ldexp(1.0, -24)),
                                                      {16, 0x7BFFu, 65504.0},
                                                      {24, 1u, std::ldexp(1.0, -78)},
                                                      {24, 0xBF0000u, -1.0}}) {
        write_tiff(path, {.width = 1, .height = 1, .bits = bits, .format = SAMPLEFORMAT_IEEEFP},
                   [&, pattern = bit_pattern](int, int, int) -> std::uint64_t { return pattern; });
        CHECK(static_cast<double>(read_image(path).data[0]) == expected);
    }
    write_tiff(path, {.width = 1, .height = 1, .bits = 24, .format = SAMPLEFORMAT_IEEEFP},
               [](int, int, int) -> std::uint64_t { return 0x7F0000; });
    CHECK(error_of([&] { read_image(path); }) == ErrorKind::kBadFile);  // infinity
}

TEST_CASE("tiff: signed integers keep their sign, and a warning says that they are values") {
    const TemporaryFolder folder;
    for (const int bits : {4, 8, 12, 16, 24, 32, 64})
        for (const bool tiled : {false, true}) {
            const TiffShape shape{.bits = bits, .format = SAMPLEFORMAT_INT, .tiled = tiled};
            INFO(label(shape));
            const auto value = [](int x, int y, int) { return std::int64_t{(x * 3 + y) % 16 - 8}; };
            write_tiff(folder / "s.tif", shape,
                       [&](int x, int y, int s) { return static_cast<std::uint64_t>(value(x, y, s)); });
            const ReadImage read = read_image_file(folder / "s.tif");
            CHECK(read.warnings.size() == 1);
            const double largest = std::ldexp(1.0, bits - 1) - 1;
            check_samples(read.image,
                          [&](int x, int y, int s) { return static_cast<double>(value(x, y, s)) / largest; });
        }
}

TEST_CASE("tiff: compressions with and without predictors") {
    const TemporaryFolder folder;
    struct Kind {
        int compression, predictor, bits, format;
    };
    std::vector<Kind> kinds;
    for (const int compression :
         {COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_DEFLATE, COMPRESSION_ZSTD})
        for (const int bits : {8, 16, 32})
            for (const int predictor : {PREDICTOR_NONE, PREDICTOR_HORIZONTAL, PREDICTOR_FLOATINGPOINT}) {
                if (predictor == PREDICTOR_FLOATINGPOINT && bits == 8) continue;
                kinds.push_back(
                    {compression, predictor, bits,
                     predictor == PREDICTOR_FLOATINGPOINT ? SAMPLEFORMAT_IEEEFP : SAMPLEFORMAT_UINT});
            }
    for (const int compression : {COMPRESSION_PACKBITS, COMPRESSION_LZMA})
        kinds.push_back({compression, 0, 8, SAMPLEFORMAT_UINT});
    for (const int compression : {COMPRESSION_CCITTRLE, COMPRESSION_CCITTFAX3, COMPRESSION_CCITTFAX4})
        kinds.push_back({compression, 0, 1, SAMPLEFORMAT_UINT});
    for (const Kind& kind : kinds)
        for (const bool tiled : {false, true})
            for (const char* mode : {"wl", "wb"}) {
                // libtiff 4.5 writes these wrongly in the other byte order.
                if (kind.predictor == PREDICTOR_FLOATINGPOINT && mode[1] == 'b') continue;
                TiffShape shape{.bits = kind.bits,
                                .format = kind.format,
                                .tiled = tiled,
                                .compression = kind.compression};
                shape.mode = mode;
                INFO(label(shape) << " predictor " << kind.predictor);
                const auto value = [](int x, int y, int) {
                    return static_cast<float>((x * 5 + y * 3) % 256) / 256;
                };
                const auto code = [&](int x, int y, int s) -> std::uint64_t {
                    if (kind.format == SAMPLEFORMAT_UINT) return noise(x, y, s, kind.bits);
                    if (kind.bits == 32) return std::bit_cast<std::uint32_t>(value(x, y, s));
                    return 0x3C00;  // 1 as a half
                };
                write_tiff(folder / "c.tif", shape, code, [&](TIFF* t) {
                    if (kind.predictor > 0) TIFFSetField(t, TIFFTAG_PREDICTOR, kind.predictor);
                });
                check_samples(read_image(folder / "c.tif"), [&](int x, int y, int s) -> double {
                    if (kind.format == SAMPLEFORMAT_UINT)
                        return static_cast<double>(noise(x, y, s, kind.bits)) /
                               (std::ldexp(1.0, kind.bits) - 1);
                    return kind.bits == 32 ? static_cast<double>(value(x, y, s)) : 1;
                });
            }
}
