// Numbers that are data: what read_image() makes of a TIFF's samples, and of the pixels that are none.
#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "formats/picture/image_io.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiff_writer.h"

using namespace imgmesh;
using Names = std::vector<std::string>;

namespace {

ReadImage read_values(const std::string& path) {
    return read_image_file(path, {.values = true});
}

void set_nodata(TIFF* tiff, const char* text) {
    const TIFFFieldInfo field = {42113,        -1, -1, TIFF_ASCII,
                                 FIELD_CUSTOM, 1,  0,  const_cast<char*>("GDALNoData")};
    TIFFMergeFieldInfo(tiff, &field, 1);
    TIFFSetField(tiff, 42113, text);
}

}  // namespace

TEST_CASE("values: integers and floats keep their own numbers, whatever they would mean as colours") {
    const TemporaryFolder folder;
    for (const int format : {SAMPLEFORMAT_UINT, SAMPLEFORMAT_INT})
        for (const int bits : {1, 4, 8, 12, 16, 24})
            for (const int photometric : {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE})
                for (const bool tiled : {false, true}) {
                    if (bits == 1 && format == SAMPLEFORMAT_INT) continue;
                    const TiffShape shape{
                        .bits = bits, .photometric = photometric, .format = format, .tiled = tiled};
                    INFO(label(shape) << " format " << format);
                    write_tiff(folder / "v.tif", shape,
                               [&](int x, int y, int s) { return noise(x, y, s, bits); });
                    const ReadImage read = read_values(folder / "v.tif");
                    CHECK(read.warnings.empty());
                    CHECK(read.image.channel_names == Names{"value"});
                    CHECK(read.image.sample_type == SampleType::kFloat);
                    CHECK(read.image.color_space == ColorSpace::kLinear);
                    check_samples(
                        read.image,
                        [&](int x, int y, int s) {
                            const auto code = static_cast<double>(noise(x, y, s, bits));
                            const bool negative =
                                format == SAMPLEFORMAT_INT && code >= std::ldexp(1.0, bits - 1);
                            return negative ? code - std::ldexp(1.0, bits) : code;
                        },
                        0);
                }
    std::vector<std::uint16_t> map(256, 7);
    write_tiff(
        folder / "p.tif", {.photometric = PHOTOMETRIC_PALETTE},
        [](int x, int y, int s) { return noise(x, y, s, 8); },
        [&](TIFF* t) { TIFFSetField(t, TIFFTAG_COLORMAP, map.data(), map.data(), map.data()); });
    check_samples(
        read_values(folder / "p.tif").image,
        [](int x, int y, int s) { return static_cast<double>(noise(x, y, s, 8)); }, 0);
}

TEST_CASE("values: channels have names that are no colours, and alpha stays alpha") {
    const TemporaryFolder folder;
    TiffShape shape{.samples = 5, .bits = 16, .photometric = PHOTOMETRIC_RGB};
    shape.extras = {EXTRASAMPLE_ASSOCALPHA, EXTRASAMPLE_UNSPECIFIED};
    write_tiff(folder / "c.tif", shape,
               [](int, int, int s) -> std::uint64_t { return s == 3 ? 13107 : 1000; });
    const Image image = read_values(folder / "c.tif").image;
    CHECK(image.channel_names == Names{"value.R", "value.G", "value.B", "A", "channel4"});
    CHECK(image.data[0] == 1000);  // not divided by alpha
    CHECK(image.data[3] == doctest::Approx(0.2));
    for (const std::string name : {"a.png", "a.bmp", "a.ppm"}) {
        INFO(name);
        const Image made = random_picture(9, 7, 3);
        write_image(folder / name, made);
        const Image data = read_image(folder / name, {.values = true});
        CHECK(data.channel_names == Names{"value.R", "value.G", "value.B"});
        for (std::size_t i = 0; i < made.data.size(); ++i)
            CHECK(data.data[i] == std::round(made.data[i] * 255));
    }
    const std::string text = "P2 3 1 4000\n0 1999 4000\n";
    save(folder / "a.pgm", {text.begin(), text.end()});
    CHECK(read_values(folder / "a.pgm").image.data == std::vector<float>{0, 1999, 4000});
    CHECK(read_image_file(folder / "a.pgm", {.nodata = 1999}).data.count() == 2);
}

TEST_CASE("nodata: by the file's tag or the caller's number, NaN too, turned as the image is") {
    const TemporaryFolder folder;
    const std::string path = folder / "n.tif";
    // -9999 at (2, 1) of a stored 3 x 2 image; orientation 6 shows it as 2 x 3, that pixel at (0, 2).
    const TiffShape shape{.width = 3, .height = 2, .bits = 16, .format = SAMPLEFORMAT_INT};
    const auto code = [](int x, int y, int) -> std::uint64_t { return x == 2 && y == 1 ? 0xD8F1 : 100; };
    write_tiff(path, shape, code, [](TIFF* t) {
        set_nodata(t, "-9999 ");
        TIFFSetField(t, TIFFTAG_ORIENTATION, ORIENTATION_RIGHTTOP);
    });
    for (const bool values : {false, true}) {
        const ReadImage read = read_image_file(path, {.values = values});
        REQUIRE(read.data.width == 2);
        REQUIRE(read.data.height == 3);
        CHECK(read.data.count() == 5);
        CHECK(!read.data.at(0, 2));
    }
    CHECK(read_image_file(path, {.file_nodata = false}).data.empty());
    CHECK(read_image_file(path, {.nodata = 100}).data.count() == 1);
    CHECK(read_image_file(path, {.nodata = 7}).data.empty());

    // All channels but alpha count. In floats, NaN is a number like others here.
    TiffShape bands{.width = 4, .height = 1, .samples = 2, .bits = 32, .format = SAMPLEFORMAT_IEEEFP};
    const auto value = [](int x, int, int s) -> std::uint64_t {
        const bool missing = x == 1 || (x == 2 && s == 0);
        return std::bit_cast<std::uint32_t>(missing ? std::numeric_limits<float>::quiet_NaN() : 3.0f);
    };
    bands.extras = {EXTRASAMPLE_UNASSALPHA};
    write_tiff(path, bands, value, [](TIFF* t) { set_nodata(t, "nan"); });
    CHECK(read_values(path).data.count() == 2);
    bands.extras = {EXTRASAMPLE_UNSPECIFIED};
    write_tiff(path, bands, value, [](TIFF* t) { set_nodata(t, "nan"); });
    CHECK(error_of([&] { read_values(path); }) == ErrorKind::kBadFile);  // one channel alone is not finite
}

TEST_CASE("nodata: blocks that a file of GDAL leaves out are filled with it, and an error without") {
    const TemporaryFolder folder;
    for (const bool named : {true, false}) {
        const auto tiff = create_tiff(folder / "s.tif");
        TIFFSetField(tiff.get(), TIFFTAG_IMAGEWIDTH, 32);
        TIFFSetField(tiff.get(), TIFFTAG_IMAGELENGTH, 16);
        TIFFSetField(tiff.get(), TIFFTAG_BITSPERSAMPLE, 8);
        TIFFSetField(tiff.get(), TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff.get(), TIFFTAG_TILEWIDTH, 16);
        TIFFSetField(tiff.get(), TIFFTAG_TILELENGTH, 16);
        if (named) set_nodata(tiff.get(), "9");
        std::vector<std::uint8_t> tile(256, 50);
        REQUIRE(TIFFWriteEncodedTile(tiff.get(), 1, tile.data(), 256) == 256);
        REQUIRE(TIFFFlush(tiff.get()) == 1);
        if (!named) {
            CHECK(error_of([&] { read_values(folder / "s.tif"); }) == ErrorKind::kBadFile);
            continue;
        }
        const ReadImage read = read_values(folder / "s.tif");
        CHECK(read.data.count() == 256);
        CHECK(!read.data.at(15, 3));
        CHECK(read.image.pixel(16, 3)[0] == 50);
    }
}

TEST_CASE("values: written as float TIFF they come back, and what is hidden is nodata") {
    const TemporaryFolder folder;
    Image image = make_image(70, 3, 3);
    image.channel_names = {"depth", "A", "height"};
    image.sample_type = SampleType::kFloat;
    image.color_space = ColorSpace::kLinear;
    for (std::size_t i = 0; i < image.data.size(); ++i)
        image.data[i] = i % 3 == 1 ? 1 : -1000 + 7.25f * static_cast<float>(i);
    image.pixel(5, 1)[1] = 0;
    write_image(folder / "w.tif", image);
    const ReadImage read = read_values(folder / "w.tif");
    CHECK(read.image.channel_names == Names{"value", "channel1"});
    CHECK(read.data.count() == 70 * 3 - 1);
    CHECK(!read.data.at(5, 1));
    for (int x = 6; x < 70; ++x) {
        CHECK(read.image.pixel(x, 1)[0] == image.pixel(x, 1)[0]);
        CHECK(read.image.pixel(x, 1)[1] == image.pixel(x, 1)[2]);
    }
    CHECK(encode_image("w.tif", image) == encode_image("w.tif", image));
}
