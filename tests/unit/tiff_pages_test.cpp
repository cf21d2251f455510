// Which page of a TIFF read_image() reads, what extra channels become, and what it refuses.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>

#include "formats/files/atomic_file.h"
#include "formats/picture/image_io.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tiff_writer.h"

using namespace imgmesh;
using Names = std::vector<std::string>;

namespace {

std::uint64_t fifty(int, int, int) {
    return 50;
}

// Sets the value of the first entry of a tag in a little-endian classic TIFF with one directory.
void set_tag(std::vector<std::uint8_t>& bytes, std::uint16_t tag, std::uint32_t value) {
    std::uint32_t at = 0;
    std::memcpy(&at, &bytes[4], 4);
    const auto count = static_cast<std::uint32_t>(bytes[at] | bytes[at + 1] << 8);
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t entry = at + 2 + 12 * i;
        if ((bytes[entry] | bytes[entry + 1] << 8) == tag) {
            const std::uint16_t kLong = 4;
            std::memcpy(&bytes[entry + 2], &kLong, 2);
            std::memcpy(&bytes[entry + 8], &value, 4);
            return;
        }
    }
    FAIL("the tag is not there");
}

}  // namespace

TEST_CASE("tiff: the first full-size page is read, not a thumbnail nor a mask before it") {
    const TemporaryFolder folder;
    const auto page = [](TIFF* tiff, int width, std::uint32_t flags, int photometric) {
        write_tiff_page(tiff, {.width = width, .height = 6, .photometric = photometric}, fifty, [&](TIFF* t) {
            if (flags != 0) TIFFSetField(t, TIFFTAG_SUBFILETYPE, flags);
        });
    };
    {
        const auto tiff = create_tiff(folder / "p.tif");
        page(tiff.get(), 5, FILETYPE_REDUCEDIMAGE, PHOTOMETRIC_MINISBLACK);
        page(tiff.get(), 7, FILETYPE_MASK, PHOTOMETRIC_MASK);
        page(tiff.get(), 20, 0, PHOTOMETRIC_MINISBLACK);
        page(tiff.get(), 30, 0, PHOTOMETRIC_MINISBLACK);
    }
    CHECK(read_image_file(folder / "p.tif").image.width == 20);
    // The first page with the older tag in place of the newer: SubfileType 2 is a thumbnail as well.
    std::vector<std::uint8_t> bytes = read_file(folder / "p.tif", 1 << 20);
    set_tag(bytes, TIFFTAG_SUBFILETYPE, OFILETYPE_REDUCEDIMAGE);
    const std::vector<std::uint8_t> from = {254, 0, 4, 0}, to = {255, 0, 3, 0};  // tag and type
    const auto at = std::search(bytes.begin(), bytes.end(), from.begin(), from.end());
    REQUIRE(at != bytes.end());
    std::copy(to.begin(), to.end(), at);
    save(folder / "p.tif", bytes);
    CHECK(read_image_file(folder / "p.tif").image.width == 20);
    CHECK(read_image_file(folder / "p.tif").warnings.empty());
    {
        const auto tiff = create_tiff(folder / "t.tif");
        page(tiff.get(), 5, FILETYPE_REDUCEDIMAGE, PHOTOMETRIC_MINISBLACK);
        page(tiff.get(), 6, FILETYPE_REDUCEDIMAGE, PHOTOMETRIC_MINISBLACK);
    }
    CHECK(read_image_file(folder / "t.tif").image.width == 5);
    CHECK(read_image_file(folder / "t.tif").warnings.size() == 1);
}

TEST_CASE("tiff: alpha is what the file calls alpha; other channels have names, and a single one a warning") {
    const TemporaryFolder folder;
    struct Case {
        int samples;
        std::vector<std::uint16_t> extras;
        Names names;
        std::size_t warnings;
    };
    constexpr std::uint16_t kOther = EXTRASAMPLE_UNSPECIFIED, kFree = EXTRASAMPLE_UNASSALPHA,
                            kBound = EXTRASAMPLE_ASSOCALPHA;
    for (const Case& c : {Case{4, {kFree}, {"R", "G", "B", "A"}, 0},
                          {4, {kBound}, {"R", "G", "B", "A"}, 0},
                          {4, {kOther}, {"R", "G", "B", "channel3"}, 1},
                          {4, {}, {"R", "G", "B", "channel3"}, 1},
                          {5, {kOther, kFree}, {"R", "G", "B", "channel3", "A"}, 0},
                          {5, {kOther, kOther}, {"R", "G", "B", "channel3", "channel4"}, 0},
                          {2, {kOther}, {"Y", "channel1"}, 1},
                          {2, {kFree}, {"Y", "A"}, 0}}) {
        INFO(c.samples << " samples, " << c.extras.size() << " extra");
        TiffShape shape{.samples = c.samples};
        if (c.samples > 2) shape.photometric = PHOTOMETRIC_RGB;
        shape.extras = c.extras;
        write_tiff(folder / "e.tif", shape,
                   [](int, int, int s) -> std::uint64_t { return s < 3 ? 51 : 102; });
        const ReadImage read = read_image_file(folder / "e.tif");
        CHECK(read.image.channel_names == c.names);
        CHECK(read.warnings.size() == c.warnings);
        // Associated alpha, here 0.4, is divided out.
        if (c.samples == 4)
            CHECK(read.image.data[0] == doctest::Approx(c.extras == std::vector{kBound} ? 0.5 : 0.2));
    }
}

TEST_CASE("tiff: what is not read is named") {
    const TemporaryFolder folder;
    const auto refused = [&](const TiffShape& shape, const char* word,
                             const std::function<void(TIFF*)>& change = {}) {
        INFO(word);
        write_tiff(folder / "n.tif", shape, fifty, change);
        std::string text;
        CHECK(error_of([&] { read_image(folder / "n.tif"); }, &text) == ErrorKind::kUnsupported);
        CHECK_MESSAGE((text.find(word) != std::string::npos), text);
    };
    refused({.photometric = PHOTOMETRIC_CFA}, "camera raw");
    refused({.samples = 3, .photometric = PHOTOMETRIC_ITULAB}, "ITU");
    refused({.bits = 64, .format = SAMPLEFORMAT_COMPLEXIEEEFP}, "complex");
    refused({}, "volumes", [](TIFF* t) { TIFFSetField(t, TIFFTAG_IMAGEDEPTH, 3); });
    write_tiff(folder / "z.tif", {}, fifty);
    std::vector<std::uint8_t> bytes = read_file(folder / "z.tif", 1 << 20);
    set_tag(bytes, TIFFTAG_COMPRESSION, COMPRESSION_JXL);
    save(folder / "z.tif", bytes);
    std::string text;
    CHECK(error_of([&] { read_image(folder / "z.tif"); }, &text) == ErrorKind::kUnsupported);
    CHECK_MESSAGE((text.find("JPEG XL") != std::string::npos), text);
}

TEST_CASE("tiff: missing pixels and lying sizes are errors, and take no memory") {
    const TemporaryFolder folder;
    // (Without compression, libtiff works the lengths out itself.)
    for (const int compression : {COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE, COMPRESSION_PACKBITS,
                                  COMPRESSION_JPEG, COMPRESSION_ZSTD}) {
        INFO("compression " << compression);
        // Pixels before the tags, so that these stay when pixels are cut out.
        write_tiff(folder / "m.tif", {.width = 64, .height = 5, .compression = compression},
                   [](int x, int y, int) -> std::uint64_t {
                       return static_cast<std::uint64_t>((x * x * 7 + y * 13) % 251);
                   });
        const std::vector<std::uint8_t> good = read_file(folder / "m.tif", 1 << 20);
        CHECK(read_image(folder / "m.tif").width == 64);
        std::vector<std::uint8_t> bytes = good;
        std::uint32_t at = 0;
        std::memcpy(&at, &bytes[4], 4);
        set_tag(bytes, TIFFTAG_STRIPBYTECOUNTS, (at - 8) / 2);
        save(folder / "m.tif", bytes);
        CHECK(error_of([&] { read_image(folder / "m.tif"); }) == ErrorKind::kBadFile);
        for (const std::uint32_t length : {0x7FFFFFFFu, 0xFFFFFFFFu}) {
            bytes = good;
            set_tag(bytes, TIFFTAG_STRIPBYTECOUNTS, length);
            save(folder / "m.tif", bytes);
            CHECK(error_of([&] { read_image(folder / "m.tif"); }) == ErrorKind::kBadFile);
        }
    }
    // Strips that all share the same bytes are bounded by the pixels that they make.
    write_tiff(folder / "s.tif", {.width = 64, .height = 5}, fifty);
    std::vector<std::uint8_t> bytes = read_file(folder / "s.tif", 1 << 20);
    set_tag(bytes, TIFFTAG_IMAGEWIDTH, 60000);
    set_tag(bytes, TIFFTAG_IMAGELENGTH, 60000);
    save(folder / "s.tif", bytes);
    std::string text;
    CHECK(error_of([&] { read_image(folder / "s.tif"); }, &text) == ErrorKind::kBadFile);
    CHECK_MESSAGE((text.find("pixels are read") != std::string::npos), text);
}
