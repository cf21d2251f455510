// Files that are broken, truncated, random, or that claim more than they hold.
#include <doctest/doctest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>
#include <optional>

#include <cstring>

#include "formats/picture/decode/picture_probe.h"
#include "formats/picture/image_io.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using Bytes = std::vector<std::uint8_t>;

namespace {

const char* const kNames[] = {"a.png", "a.jpg", "a.tif", "a.exr", "a.webp", "a.gif",
                              "a.bmp", "a.ppm", "a.tga", "a.hdr", "a.jp2",  "a.heic"};

Bytes sample_file(const TemporaryFolder& folder, const std::string& name) {
    const Image image = random_picture(64, 48, 3, 255, 7);
    write_with_oiio(folder / name, image,
                    name == "a.exr" || name == "a.hdr" ? OIIO::TypeFloat : OIIO::TypeUInt8);
    return load(folder / name);
}

Bytes bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

void put_big(Bytes& b, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) b[at + i] = static_cast<std::uint8_t>(value >> (24 - 8 * i));
}

long peak_kilobytes() {
    struct rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss;
}

}  // namespace

// Never half an image: a prefix is an error, or the whole image if only bytes after the pixels are removed.
TEST_CASE("hostile: truncated files at many lengths") {
    const TemporaryFolder folder;
    for (const std::string name : kNames) {
        const Bytes whole = sample_file(folder, name);
        const Image picture = read_image(folder / name);
        // Behind the pixels of a PNG or JPEG there may be anything or nothing.
        const bool strict = name == "a.webp" || name == "a.exr" || name == "a.bmp" || name == "a.ppm" ||
                            name == "a.jp2" || name == "a.heic";
        const std::size_t step = std::max<std::size_t>(1, whole.size() / 150);
        for (std::size_t cut = 1; cut <= whole.size(); cut += cut < 40 ? 1 : step) {
            INFO(name << " of " << whole.size() << " bytes without the last " << cut);
            save(folder / name, Bytes(whole.begin(), whole.end() - static_cast<std::ptrdiff_t>(cut)));
            Image read;
            const std::optional<ErrorKind> code = error_of([&] { read = read_image(folder / name); });
            if (code == std::nullopt) {
                CHECK_FALSE(strict);
                CHECK(max_difference(read, picture) == 0);
            } else {
                CHECK(code == ErrorKind::kBadFile);
            }
        }
    }
}

TEST_CASE("hostile: flipped bytes give an error or an image of a permitted size") {
    const TemporaryFolder folder;
    ImageLimits limits;
    limits.max_pixels = 1 << 20;
    for (const std::string name : kNames) {
        const Bytes whole = sample_file(folder, name);
        std::mt19937 random(5);
        for (int round = 0; round < 150; ++round) {
            INFO(name << " round " << round);
            Bytes bytes = whole;
            // Headers matter more than pixels.
            const std::size_t window = round % 2 ? bytes.size() : std::min<std::size_t>(bytes.size(), 400);
            for (int flips = 1 + round % 4; flips > 0; --flips)
                bytes[random() % window] = static_cast<std::uint8_t>(random());
            save(folder / name, bytes);
            Image read;
            const std::optional<ErrorKind> code =
                error_of([&] { read = read_image(folder / name, {.limits = limits}); });
            CHECK((code == std::nullopt || code == ErrorKind::kBadFile || code == ErrorKind::kUnsupported));
            if (code != std::nullopt) continue;
            CHECK(read.data.size() == read.pixel_count() * static_cast<std::size_t>(read.channels));
            CHECK(read.data.size() <= std::size_t{4} << 20);
        }
    }
}

TEST_CASE("hostile: random bytes, alone and behind every signature, are no image") {
    const TemporaryFolder folder;
    std::mt19937 random(3);
    const std::string_view signatures[] = {"",
                                           "\x89PNG\r\n\x1a\n",
                                           "\xFF\xD8\xFF\xE0",
                                           {"II*\0", 4},
                                           {"MM\0+", 4},
                                           {"\x76\x2f\x31\x01\x02\0\0\0", 8},
                                           "RIFF\x20\x01\x01\x01WEBPVP8 ",
                                           "GIF89a",
                                           "BM",
                                           "P6 ",
                                           "#?RADIANCE\n",
                                           {"\0\0\0\x0CjP  \r\n\x87\n", 12},
                                           {"\0\0\0\x18"
                                            "ftypheic",
                                            12}};
    ImageLimits limits;
    limits.max_pixels = 1 << 20;
    for (const std::string_view signature : signatures) {
        for (int round = 0; round < 20; ++round) {
            Bytes bytes = bytes_of(signature);
            for (int i = 0; i < 50 << (round % 5); ++i) bytes.push_back(static_cast<std::uint8_t>(random()));
            for (const std::string name : {"r.png", "r.tga", "r"}) {
                INFO(signature << " round " << round << " " << name);
                save(folder / name, bytes);
                const std::optional<ErrorKind> code =
                    error_of([&] { read_image(folder / name, {.limits = limits}); });
                // Any bytes are a TGA; its sizes and types seldom are.
                const bool may = name == "r.tga" && signature.empty();
                CHECK((code == ErrorKind::kBadFile || code == ErrorKind::kUnsupported || may));
            }
        }
    }
}

TEST_CASE("hostile: absurd sizes are refused before memory is taken") {
    const TemporaryFolder folder;
    const auto little = [](std::uint32_t value, int count) {
        Bytes out;
        for (int i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
        return out;
    };
    std::vector<std::pair<std::string, Bytes>> files;
    const auto add = [&](const char* name, std::initializer_list<Bytes> parts) {
        files.emplace_back(name, Bytes{});
        for (const Bytes& part : parts)
            files.back().second.insert(files.back().second.end(), part.begin(), part.end());
    };
    // The checksum is right, so only the size is wrong.
    add("png",
        {bytes_of(
             {"\x89PNG\r\n\x1a\n\0\0\0\x0DIHDR\0\x01\x86\xA0\0\x01\x86\xA0\x08\x02\0\0\0\x27\x30\x9C\x9F",
              33}),
         bytes_of({"\0\0\0\0IDAT\x35\xAF\x06\x1E\0\0\0\0IEND\xAE\x42\x60\x82", 24})});
    add("gif", {bytes_of("GIF89a"), little(65535, 2), little(65535, 2), Bytes(200, 0)});
    add("bmp", {bytes_of("BM"), Bytes(12, 0), little(40, 4), little(100000, 4), little(100000, 4),
                little(1, 2), little(24, 2), Bytes(300, 0)});
    add("webp", {bytes_of("RIFF"), little(300, 4), bytes_of("WEBPVP8X"), little(10, 4), Bytes(4, 0),
                 little(99999, 3), little(99999, 3), Bytes(300, 0)});
    add("ppm", {bytes_of("P6 100000 100000 255\n"), Bytes(300, 0)});
    add("tga", {Bytes{0, 0, 2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 24, 0}, Bytes(300, 0)});
    add("hdr", {bytes_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 100000 +X 100000\n"), Bytes(300, 0)});
    // A progressive JPEG, for which libjpeg takes memory when it is opened.
    add("jpg",
        {bytes_of({"\xFF\xD8\xFF\xC2\0\x11\x08\xFF\xFF\xFF\xFF\x03\x01\x11\0\x02\x11\x01\x03\x11\x01", 21}),
         Bytes(300, 0)});
    files.emplace_back("tif", sample_file(folder, "a.tif"));
    files.emplace_back("jp2", sample_file(folder, "a.jp2"));
    files.emplace_back("exr", sample_file(folder, "a.exr"));
    const auto patch = [](Bytes& bytes, std::string_view after, std::size_t skip, const Bytes& value) {
        const auto at = std::search(bytes.begin(), bytes.end(), after.begin(), after.end(),
                                    [](std::uint8_t b, char c) { return b == static_cast<std::uint8_t>(c); });
        REQUIRE(at != bytes.end());
        std::copy(value.begin(), value.end(), at + static_cast<std::ptrdiff_t>(after.size() + skip));
    };
    // TIFF: tags 256 and 257, SHORT in the sample, as LONG 100000.
    for (const std::uint32_t tag : {256u, 257u}) {
        Bytes& tif = files[files.size() - 3].second;
        const Bytes from = little(tag, 2);
        const Bytes type = little(3, 2);
        const auto key = std::string(from.begin(), from.end()) + std::string(type.begin(), type.end());
        Bytes value = little(4, 2);
        for (const std::uint32_t number : {1u, 100000u})
            for (const std::uint8_t byte : little(number, 4)) value.push_back(byte);
        const auto at = std::search(tif.begin(), tif.end(), key.begin(), key.end());
        REQUIRE(at != tif.end());
        std::copy(value.begin(), value.end(), at + 2);
    }
    Bytes& jp2 = files[files.size() - 2].second;
    const std::string_view size_marker = "\xFF\x4F\xFF\x51";
    const auto at = std::search(jp2.begin(), jp2.end(), size_marker.begin(), size_marker.end(),
                                [](std::uint8_t b, char c) { return b == static_cast<std::uint8_t>(c); });
    REQUIRE(at != jp2.end());
    put_big(jp2, static_cast<std::size_t>(at - jp2.begin()) + 8, 100000);
    put_big(jp2, static_cast<std::size_t>(at - jp2.begin()) + 12, 100000);
    Bytes& exr = files.back().second;
    for (const std::string_view window : {"dataWindow", "displayWindow"}) {
        Bytes corner = little(99999, 4);
        const Bytes second = corner;
        corner.insert(corner.end(), second.begin(), second.end());
        patch(exr, window, 1 + 6 + 4 + 8, corner);  // past "\0box2i\0", size and minimum
    }

    for (const auto& [extension, bytes] : files) {
        INFO(extension);
        const std::string path = folder / ("absurd." + extension);
        save(path, bytes);
        const long before = peak_kilobytes();
        std::string text;
        CHECK(error_of([&] { read_image(path); }, &text) == ErrorKind::kBadFile);
        // These two libraries find first that the file is too short for the size.
        if (extension != "webp" && extension != "exr")
            CHECK_MESSAGE((text.find("the image is") != std::string::npos), text);
        CHECK(peak_kilobytes() - before < 30000);
    }
}

TEST_CASE("hostile: limits are the caller's") {
    const TemporaryFolder folder;
    for (const std::string name : kNames) {
        INFO(name);
        sample_file(folder, name);  // 64x48 RGB
        const auto with = [&](std::int64_t pixels, int side, int channels) {
            return error_of([&] { read_image(folder / name, {.limits = {pixels, side, channels}}); });
        };
        // HEIF claims the size of its coding blocks, here 64x64.
        CHECK(with(name == "a.heic" ? 64 * 64 : 64 * 48, 64, 4) == std::nullopt);
        CHECK(with(64 * 48 - 1, 64, 4) == ErrorKind::kBadFile);
        CHECK(with(64 * 48, 63, 4) == ErrorKind::kBadFile);
        CHECK(with(64 * 48, 64, 2) == ErrorKind::kBadFile);
    }
}

// OpenEXR would take the memory first: for an attribute of 2 GB in a short file, and for one that hides
// behind another whose size is not its type's.
TEST_CASE("hostile: EXR attributes longer than the file, openly and hidden") {
    const TemporaryFolder folder;
    const std::string_view version = {"\x76\x2f\x31\x01\x02\0\0\0", 8};
    const std::string_view string = {"owner\0string\0\xFF\xFF\xFF\x7F", 17};
    // A "float" of 21 bytes, after which the header ends; OpenEXR would read 4 and go on with the string.
    const std::string_view shell = {"x\0float\0\x15\0\0\0\0\0\0\0", 16};
    for (const std::string_view before : {std::string_view(), shell}) {
        Bytes bytes(300, 'x');
        std::size_t at = 0;
        for (const std::string_view part : {version, before, string, std::string_view("\0", 1)}) {
            std::copy(part.begin(), part.end(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
            at += part.size();
        }
        save(folder / "l.exr", bytes);
        const long peak = peak_kilobytes();
        CHECK(error_of([&] { read_image(folder / "l.exr"); }) == ErrorKind::kBadFile);
        CHECK(peak_kilobytes() - peak < 30000);
    }
}

TEST_CASE("hostile: paths that lead to no image") {
    const TemporaryFolder folder;
    CHECK(error_of([&] { read_image(folder / "missing.png"); }) == ErrorKind::kIo);
    CHECK(error_of([&] { read_image(folder / ""); }) == ErrorKind::kIo);
    CHECK(error_of([&] { read_image(""); }) == ErrorKind::kIo);
    save(folder / "text.png", bytes_of("no picture at all\n"));
    CHECK(error_of([&] { read_image(folder / "text.png"); }) == ErrorKind::kBadFile);
    save(folder / "empty.png", {});
    CHECK(error_of([&] { read_image(folder / "empty.png"); }) == ErrorKind::kBadFile);
    save(folder / "script.null", bytes_of("#!/bin/sh\n"));  // OpenImageIO has a reader that takes any .null
    CHECK(error_of([&] { read_image(folder / "script.null"); }) == ErrorKind::kBadFile);
    const Bytes tif = sample_file(folder, "a.tif");
    save(folder / "photo.NEF", tif);
    CHECK(error_of([&] { read_image(folder / "photo.NEF"); }) == ErrorKind::kUnsupported);
    save(folder / "secret.tif", tif);
    ::chmod((folder / "secret.tif").c_str(), 0);
    if (::geteuid() != 0) CHECK(error_of([&] { read_image(folder / "secret.tif"); }) == ErrorKind::kIo);
}

// Found by fuzzing, when OpenImageIO read BMP.
TEST_CASE("hostile: a BMP whose pixels are outside the file") {
    const TemporaryFolder folder;
    const Bytes good = sample_file(folder, "a.bmp");
    for (const std::uint32_t offset : {0xFFFFFFFFu, 0xFFFFFF00u, 0x80000000u, 0x7FFFFFFFu, 100000u}) {
        Bytes file = good;
        std::memcpy(file.data() + 10, &offset, 4);
        save(folder / "r.bmp", file);
        CHECK(error_of([&] { read_image(folder / "r.bmp"); }) == ErrorKind::kBadFile);
    }
}

// Found by fuzzing, when OpenImageIO read BMP: runs looked up in a palette that does not exist.
TEST_CASE("hostile: a BMP's compression is one for its depth") {
    const TemporaryFolder folder;
    // 4 x 2 pixels, palette {10, 20, 30}, {40, 50, 60}: a run of four of the second, then four of the first.
    const auto read = [&](int bits, int compression) {
        Bytes file = bytes_of({"BM\0\0\0\0\0\0\0\0\x3E\0\0\0\x28\0\0\0\x04\0\0\0\x02\0\0\0\x01\0", 28});
        for (const int value :
             {bits, 0, compression, 0, 0, 0, 10, 0, 0,  0,  0,  0, 0,  0,  0,  0, 0, 0,
              2,    0, 0,           0, 0, 0, 0,  0, 30, 20, 10, 0, 60, 50, 40, 0, 4, bits == 4 ? 0x11 : 1,
              0,    0, 4,           0, 0, 1, 0,  0})
            file.push_back(static_cast<std::uint8_t>(value));
        save(folder / "r.bmp", file);
        return read_image(folder / "r.bmp");
    };
    for (const auto& [bits, compression] : {std::pair(8, 1), std::pair(4, 2)}) {
        const Image image = read(bits, compression);
        CHECK(image.width == 4);
        CHECK(image.height == 2);
        CHECK(image.pixel(0, 0)[0] == 10 / 255.f);  // rows are stored bottom up
        CHECK(image.pixel(3, 1)[2] == 60 / 255.f);
    }
    for (const auto& wrong : {std::pair(24, 1), {8, 2}, {4, 1}, {1, 1}, {32, 2}})
        CHECK(error_of([&] { read(wrong.first, wrong.second); }) == ErrorKind::kBadFile);
    for (const int compression : {4, 7, 255})
        CHECK(error_of([&] { read(24, compression); }) == ErrorKind::kUnsupported);
    CHECK(error_of([&] { read(0, 5); }) == ErrorKind::kBadFile);  // no PNG inside
}

// 2100 x 2100 pixels of one colour take some 200 bytes of WebP.
TEST_CASE("hostile: few bytes hold only so many pixels, unless the caller says otherwise") {
    const TemporaryFolder folder;
    Image image = make_image(2100, 2100, 3);
    image.data.assign(image.data.size(), 0.5f);
    const std::string path = folder / "solid.webp";
    write_image(path, image);
    std::string text;
    CHECK(error_of([&] { read_image(path); }, &text) == ErrorKind::kBadFile);
    CHECK(text.find("from so small a file") != std::string::npos);
    ImageLimits any;
    any.max_pixels_per_byte = 0;
    CHECK(read_image(path, {.limits = any}).width == 2100);
    // Up to four megapixels nobody asks for the bytes.
    image = make_image(2048, 2048, 3);
    write_image(path, image);
    CHECK(read_image(path).width == 2048);
}
