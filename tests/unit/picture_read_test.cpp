// How read_image() reads files that other software wrote.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPreviewImage.h>
#include <OpenEXR/ImfStandardAttributes.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <doctest/doctest.h>

#include <limits>

#include "formats/picture/color/icc_profile.h"
#include "formats/picture/image_io.h"
#include "libcore/image/color.h"
#include "tests/support/picture_files.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;
using Names = std::vector<std::string>;

TEST_CASE("read: integers of lossless formats come back exactly, with names and sample type") {
    const TemporaryFolder folder;
    struct Case {
        const char* name;
        int channels;
        OIIO::TypeDesc type;
    };
    const Case cases[] = {{"rgb.png", 3, OIIO::TypeUInt8},     {"rgb16.png", 3, OIIO::TypeUInt16},
                          {"grey.png", 1, OIIO::TypeUInt8},    {"grey16.png", 1, OIIO::TypeUInt16},
                          {"ya.png", 2, OIIO::TypeUInt8},      {"rgba.png", 4, OIIO::TypeUInt8},
                          {"rgba16.png", 4, OIIO::TypeUInt16}, {"rgb.tif", 3, OIIO::TypeUInt8},
                          {"rgba.tif", 4, OIIO::TypeUInt16},   {"grey.tif", 1, OIIO::TypeUInt16},
                          {"rgb.bmp", 3, OIIO::TypeUInt8},     {"rgb.tga", 3, OIIO::TypeUInt8},
                          {"rgba.tga", 4, OIIO::TypeUInt8},    {"rgb.ppm", 3, OIIO::TypeUInt8},
                          {"grey.pgm", 1, OIIO::TypeUInt8}};
    for (const Case& c : cases) {
        INFO(std::string(c.name));
        const bool wide = c.type == OIIO::TypeUInt16;
        const Image made = random_picture(13, 7, c.channels, wide ? 65535 : 255);
        write_with_oiio(folder / c.name, made, c.type);
        const Image read = read_image(folder / c.name);
        CHECK(max_difference(read, made) == 0);
        CHECK(read.channel_names == made.channel_names);
        CHECK(read.sample_type == (wide ? SampleType::kUint16 : SampleType::kUint8));
        CHECK(read.color_space == ColorSpace::kSrgb);
    }
}

TEST_CASE("read: Netpbm by hand: plain text, bits and 16 bits") {
    const TemporaryFolder folder;
    const auto read = [&](const std::string& text) {
        save(folder / "n.pnm", {text.begin(), text.end()});
        return read_image(folder / "n.pnm");
    };
    CHECK(read("P3 2 1 255\n255 0 51  0 102 255\n").data == std::vector<float>{1, 0, 0.2f, 0, 0.4f, 1});
    CHECK(read("P1 3 1\n0 1 0\n").data == std::vector<float>{1, 0, 1});
    const Image wide = read("P5 2 1 65535\n" + std::string("\x80\x01\xFF\xFF", 4));
    CHECK(wide.sample_type == SampleType::kUint16);
    CHECK(wide.data == std::vector<float>{32769.0f / 65535, 1});
}

TEST_CASE("read: floats stay, and are linear") {
    const TemporaryFolder folder;
    Image made = random_picture(9, 5, 3);
    made.data[0] = 17.5f;
    made.data[1] = -0.25f;
    for (const std::string name : {"f.tif", "f.exr"}) {
        INFO(name);
        write_with_oiio(folder / name, made, OIIO::TypeFloat);
        const Image read = read_image(folder / name);
        CHECK(max_difference(read, made) == 0);
        CHECK(read.sample_type == SampleType::kFloat);
        CHECK(read.color_space == ColorSpace::kLinear);
    }
    write_with_oiio(folder / "h.exr", made, OIIO::TypeHalf);
    CHECK(read_image(folder / "h.exr").sample_type == SampleType::kHalf);
    CHECK(max_difference(read_image(folder / "h.exr"), made) < 5e-4f);
    write_with_oiio(folder / "f.hdr", random_picture(9, 5, 3), OIIO::TypeFloat);
    CHECK(read_image(folder / "f.hdr").color_space == ColorSpace::kLinear);
}

TEST_CASE("read: lossy formats come back alike, and a content under a wrong name too") {
    const TemporaryFolder folder;
    Image made = make_image(64, 48, 3);
    for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 64; ++x)
            for (int c = 0; c < 3; ++c)
                made.pixel(x, y)[c] =
                    0.2f + 0.1f * static_cast<float>(c) + 0.005f * static_cast<float>(x + y);
    for (const std::string name : {"a.jpg", "a.webp", "a.jp2", "a.heic", "a.gif"}) {
        INFO(name);
        write_with_oiio(folder / name, made, OIIO::TypeUInt8);
        const Image read = read_image(folder / name);
        CHECK(read.width == 64);
        CHECK(read.height == 48);
        double sum = 0;
        for (int y = 0; y < 48; ++y)
            for (int x = 0; x < 64; ++x)
                for (int c = 0; c < 3; ++c)
                    sum += std::abs(static_cast<double>(read.pixel(x, y)[c]) -
                                    static_cast<double>(made.pixel(x, y)[c]));
        CHECK(sum / (64 * 48 * 3) < 0.02);
    }
    std::filesystem::rename(folder / "a.jpg", folder / "b.png");
    CHECK(read_image(folder / "b.png").width == 64);
}

// Stored 3x2, each pixel another grey; the displayed images are drawn from EXIF's definition of the tag: 1
// the first row is the top and the first column the left side, 2 top right, 3 bottom right, 4 bottom left, 5
// left top, 6 right top, 7 right bottom, 8 left bottom.
TEST_CASE("read: all eight EXIF orientations") {
    const TemporaryFolder folder;
    Image stored = make_image(3, 2, 1);
    stored.data = {0, 1, 2, 3, 4, 5};
    for (float& x : stored.data) x *= 51.0f / 255;
    const std::vector<std::vector<int>> displayed = {
        {0, 1, 2, 3, 4, 5}, {2, 1, 0, 5, 4, 3}, {5, 4, 3, 2, 1, 0}, {3, 4, 5, 0, 1, 2},
        {0, 3, 1, 4, 2, 5}, {3, 0, 4, 1, 5, 2}, {5, 2, 4, 1, 3, 0}, {2, 5, 1, 4, 0, 3}};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        INFO("orientation " << orientation);
        write_with_oiio(folder / "o.tif", stored, OIIO::TypeUInt8,
                        [&](OIIO::ImageSpec& spec) { spec.attribute("Orientation", orientation); });
        const Image read = read_image(folder / "o.tif");
        CHECK(read.width == (orientation <= 4 ? 3 : 2));
        CHECK(read.height == (orientation <= 4 ? 2 : 3));
        for (std::size_t i = 0; i < 6; ++i)
            CHECK(std::lround(read.data[i] * 5) == displayed[static_cast<std::size_t>(orientation) - 1][i]);
    }
    // JPEG carries it in EXIF; here only the shape tells, as 3x2 does not survive its compression.
    write_with_oiio(folder / "o.jpg", stored, OIIO::TypeUInt8,
                    [](OIIO::ImageSpec& spec) { spec.attribute("Orientation", 6); });
    CHECK(read_image(folder / "o.jpg").width == 2);
}

TEST_CASE("read: associated alpha is divided out, and nothing where it is zero") {
    const TemporaryFolder folder;
    Image made = make_image(3, 1, 4);
    made.data = {0.4f, 0.2f, 0.1f, 0.5f, 0.3f, 0.2f, 0.1f, 0, 0.7f, 0.8f, 0.9f, 1};
    const std::vector<float> expected = {0.8f, 0.4f, 0.2f, 0.5f, 0.3f, 0.2f, 0.1f, 0, 0.7f, 0.8f, 0.9f, 1};
    const auto associated = [](OIIO::ImageSpec& spec) { spec.erase_attribute("oiio:UnassociatedAlpha"); };
    for (const std::string name : {"a.exr", "a.tif"}) {
        INFO(name);
        write_with_oiio(folder / name, made, OIIO::TypeFloat, associated);
        const Image read = read_image(folder / name);
        for (std::size_t i = 0; i < expected.size(); ++i) CHECK(read.data[i] == doctest::Approx(expected[i]));
    }
    write_with_oiio(folder / "u.tif", made, OIIO::TypeFloat);  // says that it is unassociated
    CHECK(max_difference(read_image(folder / "u.tif"), made) == 0);
}

TEST_CASE("read: the colour space is the caller's, else the profile's, else the file's") {
    const TemporaryFolder folder;
    const Image made = random_picture(5, 4, 3);
    for (const ColorSpace space : {ColorSpace::kSrgb, ColorSpace::kLinear, ColorSpace::kRec709,
                                   ColorSpace::kGamma22, ColorSpace::kAdobeRgb, ColorSpace::kDisplayP3}) {
        const auto icc = icc_from_color_space(space);
        for (const std::string name : {"c.png", "c.jpg", "c.tif"}) {
            INFO(name);
            write_with_oiio(folder / name, made, OIIO::TypeUInt8, [&](OIIO::ImageSpec& spec) {
                spec.attribute("ICCProfile",
                               OIIO::TypeDesc(OIIO::TypeDesc::UINT8, static_cast<int>(icc.size())),
                               icc.data());
            });
            CHECK(read_image(folder / name).color_space == space);
            CHECK(read_image(folder / name, {.color_space = ColorSpace::kRec709}).color_space ==
                  ColorSpace::kRec709);
        }
    }
    const auto with_gamma = [&](float gamma) {
        write_with_oiio(folder / "g.png", made, OIIO::TypeUInt16, [&](OIIO::ImageSpec& spec) {
            spec.attribute("oiio:ColorSpace", "GammaCorrected");
            spec.attribute("oiio:Gamma", gamma);
        });
        return read_image(folder / "g.png");
    };
    CHECK(with_gamma(2.2f).color_space == ColorSpace::kGamma22);
    CHECK(max_difference(with_gamma(2.2f), made) < 1e-4f);
    // Another gamma is converted to sRGB; the light, value^gamma, stays.
    const Image other = with_gamma(1.8f);
    CHECK(other.color_space == ColorSpace::kSrgb);
    for (std::size_t i = 0; i < made.data.size(); ++i)
        CHECK(linear_from_encoded(ColorSpace::kSrgb, Vec3f::Constant(other.data[i]))[0] ==
              doctest::Approx(std::pow(made.data[i], 1.8f)).epsilon(1e-3));
}

namespace {

// One channel or more of value x + 10 y in file coordinates, plus the channel's number times 100.
void write_exr(const std::string& path, const Imath::Box2i& shown, const Imath::Box2i& stored,
               const Names& channels, bool tiled = false,
               Imf::Compression compression = Imf::ZIP_COMPRESSION) {
    Imf::Header header(shown, stored, 1, {0, 0}, 1, Imf::INCREASING_Y, compression);
    const int width = stored.max.x - stored.min.x + 1, height = stored.max.y - stored.min.y + 1;
    std::vector<std::vector<float>> planes;
    Imf::FrameBuffer buffer;
    for (std::size_t c = 0; c < channels.size(); ++c) {
        auto& plane = planes.emplace_back();
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                plane.push_back(static_cast<float>(stored.min.x + x + 10 * (stored.min.y + y)) +
                                100 * static_cast<float>(c));
        header.channels().insert(channels[c], Imf::Channel(Imf::FLOAT));
        buffer.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, plane.data(), stored));
    }
    if (tiled) {
        header.setTileDescription({4, 3});
        Imf::TiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
    } else {
        Imf::OutputFile file(path.c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(height);
    }
}

}  // namespace

TEST_CASE("read: CMYK, bits and palettes become RGB or grey") {
    const TemporaryFolder folder;
    Image ink = make_image(4, 4, 4);
    for (std::size_t i = 0; i < ink.data.size(); i += 4) ink.data[i] = 1;  // cyan alone
    write_with_oiio(folder / "cmyk.tif", ink, OIIO::TypeUInt8, [](OIIO::ImageSpec& spec) {
        spec.attribute("tiff:ColorSpace", "CMYK");
        spec.channelnames = {"C", "M", "Y", "K"};
        spec.attribute("oiio:ColorSpace", "CMYK");
    });
    const Image cyan = read_image(folder / "cmyk.tif");
    CHECK(cyan.channel_names == Names{"R", "G", "B"});
    CHECK(cyan.pixel(2, 2)[0] == 0);
    CHECK(cyan.pixel(2, 2)[1] == 1);

    Image bits = make_image(9, 2, 1);
    for (std::size_t i = 0; i < bits.data.size(); i += 2) bits.data[i] = 1;
    write_with_oiio(folder / "bits.tif", bits, OIIO::TypeUInt8,
                    [](OIIO::ImageSpec& spec) { spec.attribute("oiio:BitsPerSample", 1); });
    CHECK(max_difference(read_image(folder / "bits.tif"), bits) == 0);
    CHECK(read_image(folder / "bits.tif").channel_names == Names{"Y"});

    // A GIF is all palettes; the first frame is the image.
    const auto out = OIIO::ImageOutput::create("gif");
    const std::vector<OIIO::ImageSpec> specs(2, OIIO::ImageSpec(4, 4, 3, OIIO::TypeUInt8));
    REQUIRE(out->open(folder / "two.gif", 2, specs.data()));
    for (const float grey : {1.0f, 0.0f}) {
        const std::vector<float> frame(4 * 4 * 3, grey);
        REQUIRE(out->write_image(OIIO::TypeFloat, frame.data()));
        if (grey == 1) REQUIRE(out->open(folder / "two.gif", specs[1], OIIO::ImageOutput::AppendSubimage));
    }
    REQUIRE(out->close());
    const Image first = read_image(folder / "two.gif");
    CHECK(first.channel_names == Names{"R", "G", "B", "A"});
    for (const float x : first.data) CHECK(x == 1);
}

// OpenImageIO writes no such WebP, so the chunks are put together here (WebP container specification).
TEST_CASE("read: a WebP's orientation and profile") {
    const TemporaryFolder folder;
    const Image stored = random_picture(6, 3, 3);
    write_image(folder / "w.webp", stored);
    const std::vector<std::uint8_t> plain = load(folder / "w.webp");
    const std::string bitstream(plain.begin() + 12, plain.end());
    const auto number = [](std::size_t value, int count) {
        std::string out;
        for (int i = 0; i < count; ++i) out += static_cast<char>(value >> (8 * i) & 0xFF);
        return out;
    };
    const auto chunk = [&](const std::string& name, const std::string& body) {
        return name + number(body.size(), 4) + body + std::string(body.size() % 2, '\0');
    };
    const std::string exif = "II*" + number(0, 1) + number(8, 4) + number(1, 2) + number(0x0112, 2) +
                             number(3, 2) + number(1, 4) + number(6, 4) + number(0, 4);
    const auto icc = icc_from_color_space(ColorSpace::kDisplayP3);
    const std::string chunks = chunk("VP8X", number(0x28, 4) + number(5, 3) + number(2, 3)) +
                               chunk("ICCP", {icc.begin(), icc.end()}) + bitstream + chunk("EXIF", exif);
    const std::string file = "RIFF" + number(4 + chunks.size(), 4) + "WEBP" + chunks;
    save(folder / "w.webp", {file.begin(), file.end()});
    const Image read = read_image(folder / "w.webp");
    CHECK(read.color_space == ColorSpace::kDisplayP3);
    REQUIRE(read.width == 3);
    REQUIRE(read.height == 6);
    // 6: the first stored row is the right side, the first column the top.
    CHECK(read.pixel(2, 0)[1] == stored.pixel(0, 0)[1]);
    CHECK(read.pixel(0, 5)[1] == stored.pixel(5, 2)[1]);
}

// The display window is the image; the data window may be smaller, larger, or elsewhere.
TEST_CASE("read: an EXR's windows, tiles and compressions") {
    const TemporaryFolder folder;
    const Imath::Box2i shown({2, 3}, {7, 8});
    for (const Imath::Box2i& stored :
         {Imath::Box2i({2, 3}, {7, 8}), Imath::Box2i({4, 5}, {5, 6}), Imath::Box2i({-1, -2}, {12, 11}),
          Imath::Box2i({5, 0}, {20, 4}), Imath::Box2i({30, 30}, {33, 31})}) {
        for (const bool tiled : {false, true}) {
            INFO(stored.min.x << " " << stored.min.y << " tiled " << tiled);
            write_exr(folder / "w.exr", shown, stored, {"Y"}, tiled);
            const Image read = read_image(folder / "w.exr");
            REQUIRE(read.width == 6);
            REQUIRE(read.height == 6);
            for (int y = 3; y <= 8; ++y)
                for (int x = 2; x <= 7; ++x)
                    CHECK(read.pixel(x - 2, y - 3)[0] ==
                          (stored.intersects(Imath::V2i(x, y)) ? static_cast<float>(x + 10 * y) : 0.0f));
        }
    }
    for (const auto compression : {Imf::NO_COMPRESSION, Imf::RLE_COMPRESSION, Imf::ZIPS_COMPRESSION,
                                   Imf::PIZ_COMPRESSION, Imf::PXR24_COMPRESSION}) {
        write_exr(folder / "c.exr", shown, shown, {"R", "G", "B"}, false, compression);
        CHECK(read_image(folder / "c.exr").pixel(1, 1)[2] == doctest::Approx(243).epsilon(1e-4));
    }
}

TEST_CASE("read: an EXR's channels come colour first, then by name") {
    const TemporaryFolder folder;
    write_exr(folder / "n.exr", {{0, 0}, {2, 2}}, {{0, 0}, {2, 2}}, {"A", "B", "G", "R", "Z", "normal.X"});
    const Image read = read_image(folder / "n.exr");
    CHECK(read.channel_names == Names{"R", "G", "B", "A", "Z", "normal.X"});
    CHECK(read.pixel(1, 1)[4] == 411);  // Z is no colour: not divided by alpha
    CHECK(read.pixel(1, 1)[0] == doctest::Approx(311.0 / 11));
}

// Attributes of other software do no harm, whatever their type.
TEST_CASE("read: an EXR with a preview and unusual attributes") {
    const TemporaryFolder folder;
    Imf::Header header(2, 2);
    header.channels().insert("Y", Imf::Channel(Imf::FLOAT));
    const std::vector<Imf::PreviewRgba> preview(12, Imf::PreviewRgba(1, 2, 3));
    header.setPreviewImage(Imf::PreviewImage(4, 3, preview.data()));
    Imf::addKeyCode(header, Imf::KeyCode(1, 2, 3));
    Imf::addMultiView(header, {"left", "right"});
    Imf::addOwner(header, "someone");
    const std::vector<float> samples = {1, 2, 3, 4};
    Imf::FrameBuffer buffer;
    buffer.insert("Y", Imf::Slice::Make(Imf::FLOAT, samples.data(), {0, 0}, 2, 2));
    {
        Imf::OutputFile file((folder / "p.exr").c_str(), header);
        file.setFrameBuffer(buffer);
        file.writePixels(2);
    }
    CHECK(read_image(folder / "p.exr").data == samples);
}

TEST_CASE("read: the first sample that is no number is named") {
    const TemporaryFolder folder;
    for (const std::string name : {"n.exr", "n.tif"}) {
        for (const float bad :
             {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
            INFO(name);
            Image made = random_picture(6, 5, 3);
            made.pixel(4, 2)[1] = bad;
            made.pixel(5, 4)[0] = bad;
            write_with_oiio(folder / name, made, OIIO::TypeFloat);
            std::string text;
            CHECK(error_of([&] { read_image(folder / name); }, &text) == ErrorKind::kBadFile);
            CHECK(text.find("channel G of pixel (4, 2)") != std::string::npos);
        }
    }
}
