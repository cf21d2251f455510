// A picture that is rewritten by rows has the samples that it had.
#include <doctest/doctest.h>

#include <random>

#include "formats/picture/spool.h"
#include "libcore/base/error.h"
#include "tests/support/jpeg_writer.h"
#include "tests/support/png_writer.h"
#include "tests/support/region_checks.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

// Of the spooled file, whatever a caller wants: what read_image() gives of the original.
void check_spooled(const std::string& path, const std::string& spooled, int step,
                   const ReadImageOptions& options = {}) {
    spool_picture(path, spooled, options);
    const ReadImage whole = read_image_file(path, options);
    const RegionSource source(path, options);
    CHECK(source.facts().access == RegionAccess::kSpool);
    // Also without a copy, from the top on, where it cannot be held.
    ReadImageOptions narrow = options;
    narrow.limits.max_pixels = static_cast<std::int64_t>(whole.image.pixel_count()) - 1;
    const RegionSource rows(path, narrow);
    for (int y = 0; y < whole.image.height; y += step) {
        const PixelRect band{std::min(5, whole.image.width - 1), y, whole.image.width,
                             std::min(y + step, whole.image.height)};
        check_part(rows.read_region(band), whole, band);
    }
    check_copy(path, spooled, step, options);
}

Image busy(int width, int height, int channels) {
    Image image = make_image(width, height, channels);
    std::mt19937 random(7);
    for (float& sample : image.data) sample = static_cast<float>(random() % 256) / 255.0f;
    return image;
}

ErrorKind failure(const std::string& path, const std::string& out, std::string* text = nullptr,
                  const ReadImageOptions& options = {}) {
    try {
        spool_picture(path, out, options);
    } catch (const Error& error) {
        if (text) *text = error.what();
        return error.kind();
    }
    return ErrorKind::kInternal;
}

}  // namespace

TEST_CASE("spool: PNG of every kind") {
    const TemporaryFolder folder;
    const std::vector<std::pair<int, std::vector<int>>> types = {{PNG_COLOR_TYPE_GRAY, {1, 2, 4, 8, 16}},
                                                                 {PNG_COLOR_TYPE_RGB, {8, 16}},
                                                                 {PNG_COLOR_TYPE_PALETTE, {1, 2, 4, 8}},
                                                                 {PNG_COLOR_TYPE_GRAY_ALPHA, {8, 16}},
                                                                 {PNG_COLOR_TYPE_RGB_ALPHA, {8, 16}}};
    for (const auto& [type, depths] : types)
        for (const int bits : depths)
            for (const bool transparent : {false, true}) {
                if (transparent && type & PNG_COLOR_MASK_ALPHA) continue;
                const int color_type = type;  // clang 14 captures no structured binding
                INFO("type " << color_type << ", " << bits << " bits, transparent " << transparent);
                write_png(folder / "k.png", 301, 270, {type, bits, false, transparent}, 3);
                check_spooled(folder / "k.png", folder / "k.tif", 150);
                check_spooled(folder / "k.png", folder / "k.tif", 150, {.values = true});
                check_spooled(folder / "k.png", folder / "k.tif", 150, {.values = true, .nodata = 1});
            }
}

TEST_CASE("spool: the colour statements of PNG stay") {
    const TemporaryFolder folder;
    for (const ColorSpace space : {ColorSpace::kDisplayP3, ColorSpace::kAdobeRgb, ColorSpace::kSrgb}) {
        Image image = busy(40, 30, 3);
        image.color_space = space;
        write_image(folder / "c.png", image);
        check_spooled(folder / "c.png", folder / "c.tif", 16);
        check_spooled(folder / "c.png", folder / "c.tif", 16, {.color_space = ColorSpace::kLinear});
    }
}

TEST_CASE("spool: JPEG, baseline, progressive and arithmetic, grey, colour and ink") {
    const TemporaryFolder folder;
    for (const int channels : {1, 3, 4})
        for (const bool progressive : {false, true})
            for (const bool arithmetic : {false, true})
                for (const bool adobe : {false, true}) {
                    if (adobe && channels < 4) continue;
                    const JpegKind kind{.channels = channels,
                                        .progressive = progressive,
                                        .arithmetic = arithmetic,
                                        .ink = adobe ? JCS_YCCK : JCS_CMYK,
                                        .adobe = adobe};
                    save(folder / "j.jpg", encoded(busy(301, 270, channels), kind));
                    check_spooled(folder / "j.jpg", folder / "j.tif", 150);
                    check_spooled(folder / "j.jpg", folder / "j.tif", 150, {.values = true});
                }
}

TEST_CASE("spool: a broken picture is an error, and leaves no file") {
    const TemporaryFolder folder;
    write_image(folder / "a.png", busy(300, 300, 3));
    save(folder / "a.jpg", encoded(busy(300, 300, 3), {}));
    save(folder / "p.jpg", encoded(busy(300, 300, 3), {.progressive = true}));
    for (const char* name : {"a.png", "a.jpg", "p.jpg"}) {
        const std::vector<std::uint8_t> good = load(folder / name);
        for (const std::size_t size :
             {good.size() / 2, good.size() / 4, good.size() - 200, std::size_t{40}}) {
            INFO(name << " cut to " << size);
            save(folder / "cut", {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)});
            CHECK(failure(folder / "cut", folder / "out.tif") == ErrorKind::kBadFile);
        }
        // A byte of the pixels, which only the checksums of PNG know.
        if (std::string(name) != "a.png") continue;
        std::vector<std::uint8_t> bytes = good;
        bytes[bytes.size() / 2] ^= 0x10;
        save(folder / "cut", bytes);
        CHECK(failure(folder / "cut", folder / "out.tif") == ErrorKind::kBadFile);
    }
    CHECK(folder.count() == 4);
    write_png(folder / "i.png", 20, 20, {PNG_COLOR_TYPE_RGB, 8, true, false}, 1);
    CHECK(failure(folder / "i.png", folder / "out.tif") == ErrorKind::kUnsupported);
    CHECK(RegionSource(folder / "i.png").facts().access == RegionAccess::kWhole);
    check_regions(folder / "i.png", 7);
}

TEST_CASE("spool: the coefficients of progressive JPEG are counted before memory is taken") {
    const TemporaryFolder folder;
    save(folder / "p.jpg", encoded(busy(300, 300, 3), {.horizontal = 1, .vertical = 1, .progressive = true}));
    ReadImageOptions options;
    options.limits.max_memory = 500000;
    std::string text;
    CHECK(failure(folder / "p.jpg", folder / "out.tif", &text, options) == ErrorKind::kBadFile);
    CHECK_MESSAGE((text.find("554496 bytes") != std::string::npos), text);  // 3 x 38 x 38 blocks of 64 x 2
}

TEST_CASE("spool: a sweep of rows ends where they are broken") {
    const TemporaryFolder folder;
    write_image(folder / "a.png", busy(300, 300, 3));
    std::vector<std::uint8_t> bytes = load(folder / "a.png");
    bytes.resize(bytes.size() / 2);
    save(folder / "a.png", bytes);
    ReadImageOptions options;
    options.limits.max_pixels = 3000;  // of a part: three rows
    const RegionSource source(folder / "a.png", options);
    int rows = 0, broken = 0;
    source.sweep([&](const PixelRect& part) {
        try {
            (void)source.read(part);
        } catch (const Error&) {
            ++broken;
            throw;
        }
        rows += part.height();
        return true;
    });
    CHECK(rows == 0);  // what is above may be wrong already
    CHECK(broken == 1);
}
