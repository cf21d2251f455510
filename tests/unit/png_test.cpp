// PNG compared with OpenImageIO, which reads what we write and what we read.
#include <doctest/doctest.h>

#include "formats/picture/image_io.h"
#include "libcore/base/parallel.h"
#include "tests/support/picture_files.h"
#include "tests/support/png_writer.h"
#include "tests/support/temporary_folder.h"

using namespace imgmesh;

namespace {

// The codes that OpenImageIO reads.
template <typename Code>
std::vector<Code> oiio_codes(const std::string& path, OIIO::TypeDesc type, int channels) {
    OIIO::ImageSpec spec, config;
    config.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::create("png");
    REQUIRE(input->open(path, spec, config));
    REQUIRE(spec.nchannels == channels);
    REQUIRE(spec.format == type);
    std::vector<Code> codes(static_cast<std::size_t>(spec.width * spec.height * spec.nchannels));
    REQUIRE(input->read_image(0, 0, 0, spec.nchannels, type, codes.data()));
    return codes;
}

void check_like_oiio(const std::string& path, const Image& image) {
    const auto compare = [&](const auto& codes, float most) {
        std::size_t wrong = codes.size() == image.data.size() ? 0 : 1;
        for (std::size_t i = 0; i < codes.size() && i < image.data.size(); ++i)
            wrong += image.data[i] != static_cast<float>(codes[i]) / most;
        CHECK(wrong == 0);
    };
    if (image.sample_type == SampleType::kUint16)
        compare(oiio_codes<std::uint16_t>(path, OIIO::TypeUInt16, image.channels), 65535);
    else
        compare(oiio_codes<std::uint8_t>(path, OIIO::TypeUInt8, image.channels), 255);
}

constexpr std::pair<int, int> kSizes[] = {{1, 1}, {1, 9}, {9, 1}, {3, 3}, {8, 8}, {37, 21}};

}  // namespace

// All of the specification's table 11.1, interlaced and not, with and without transparent colours.
TEST_CASE("png: every kind reads as OpenImageIO reads it") {
    const TemporaryFolder folder;
    const std::vector<std::pair<int, std::vector<int>>> types = {{PNG_COLOR_TYPE_GRAY, {1, 2, 4, 8, 16}},
                                                                 {PNG_COLOR_TYPE_RGB, {8, 16}},
                                                                 {PNG_COLOR_TYPE_PALETTE, {1, 2, 4, 8}},
                                                                 {PNG_COLOR_TYPE_GRAY_ALPHA, {8, 16}},
                                                                 {PNG_COLOR_TYPE_RGB_ALPHA, {8, 16}}};
    unsigned seed = 0;
    for (const auto& [type, depths] : types)
        for (const int bits : depths)
            for (const bool interlaced : {false, true})
                for (const bool transparent : {false, true})
                    for (const auto& [width, height] : kSizes) {
                        if (transparent && type & PNG_COLOR_MASK_ALPHA) continue;
                        INFO("type " << type << ", " << bits << " bits, interlaced " << interlaced
                                     << ", transparent " << transparent << ", " << width << " x " << height);
                        write_png(folder / "k.png", width, height, {type, bits, interlaced, transparent},
                                  ++seed);
                        const Image image = read_image(folder / "k.png");
                        CHECK(image.width == width);
                        CHECK(image.height == height);
                        check_like_oiio(folder / "k.png", image);
                    }
}

TEST_CASE("png: what is written reads as OpenImageIO reads it, and comes back") {
    const TemporaryFolder folder;
    for (const bool wide : {false, true})
        for (int channels = 1; channels <= 4; ++channels)
            for (const auto& [width, height] : kSizes) {
                INFO((wide ? 16 : 8) << " bits, " << channels << " channels, " << width << " x " << height);
                Image image = random_picture(width, height, channels, wide ? 65535 : 255, unsigned(channels));
                image.sample_type = wide ? SampleType::kUint16 : SampleType::kUint8;
                write_image(folder / "w.png", image);
                check_like_oiio(folder / "w.png", image);
                CHECK(read_image(folder / "w.png").data == image.data);
            }
}

// Each filter is the best somewhere: constant rows, ramps along and down, both, noise.
TEST_CASE("png: smooth images come back whatever filter packs them best, the same bytes for any threads") {
    const TemporaryFolder folder;
    for (int pattern = 0; pattern < 6; ++pattern) {
        INFO("pattern " << pattern);
        Image image = make_image(64, 50, 3);
        std::mt19937 random(3);
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x)
                for (int c = 0; c < 3; ++c) {
                    const int codes[] = {40 * c,        3 * x + c,          4 * y + c,
                                         x + 2 * y + c, x * y / 20 + 9 * c, static_cast<int>(random() % 256)};
                    image.pixel(x, y)[c] = static_cast<float>(codes[pattern] % 256) / 255.0f;
                }
        std::vector<std::uint8_t> one, two;
        {
            const ThreadLimit limit(1);
            write_image(folder / "s.png", image);
            one = load(folder / "s.png");
        }
        const ThreadLimit limit(2);
        write_image(folder / "s.png", image);
        two = load(folder / "s.png");
        CHECK(one == two);
        CHECK(read_image(folder / "s.png").data == image.data);
        if (pattern < 4)
            CHECK(one.size() < 700);  // 9.6 kB of samples, of which the filters leave next to nothing
    }
}

TEST_CASE("png: orientation from EXIF") {
    const TemporaryFolder folder;
    Image stored = random_picture(3, 2, 3);
    write_with_oiio(folder / "o.png", stored, OIIO::TypeUInt8);
    std::vector<std::uint8_t> bytes = load(folder / "o.png");
    // An eXIf chunk behind IHDR (which ends at 33): a directory of the tag Orientation, 6. Its CRC is
    // computed here bit by bit, as the specification has it (annex D).
    std::vector<std::uint8_t> chunk = {'e', 'X', 'I', 'f', 'I', 'I', '*', 0, 8, 0, 0, 0, 1, 0, 0x12,
                                       1,   3,   0,   1,   0,   0,   0,   6, 0, 0, 0, 0, 0, 0, 0};
    std::uint32_t crc = 0xFFFFFFFFu;
    for (const std::uint8_t byte : chunk) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    crc = ~crc;
    for (int shift = 24; shift >= 0; shift -= 8) chunk.push_back(static_cast<std::uint8_t>(crc >> shift));
    chunk.insert(chunk.begin(), {0, 0, 0, static_cast<std::uint8_t>(chunk.size() - 8)});
    bytes.insert(bytes.begin() + 33, chunk.begin(), chunk.end());
    save(folder / "o.png", bytes);
    const Image read = read_image(folder / "o.png");
    REQUIRE(read.width == 2);
    REQUIRE(read.height == 3);
    CHECK(read.pixel(1, 0)[0] == stored.pixel(0, 0)[0]);  // 6: the first stored row is the right side
    CHECK(read.pixel(0, 2)[0] == stored.pixel(2, 1)[0]);
}
