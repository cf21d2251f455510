// BMP files made by hand, byte by byte.
#include <doctest/doctest.h>

#include "tests/support/bmp_file.h"
#include "tests/support/small_pictures.h"

using namespace imgmesh;
using Codes = std::vector<int>;
using Names = std::vector<std::string>;
using Warnings = std::vector<std::string>;

namespace {

// Red, green / blue, white as B G R, from the bottom up, with the padding of rows to 4 bytes.
FileBytes four_colors() {
    return FileBytes().put({255, 0, 0, 255, 255, 255, 0, 0, 0, 0, 255, 0, 255, 0, 0, 0});
}
const Codes kFour = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

// Black, red, grey 100; 4 bytes a colour.
FileBytes three_colors() {
    return FileBytes().put({0, 0, 0, 0, 0, 0, 255, 0, 100, 100, 100, 0});
}

// A bitmap with masks of one row.
Image masked(int bits, std::vector<std::uint32_t> masks, FileBytes pixels, int width,
             std::uint32_t header = 40, std::uint32_t compression = 3) {
    return read_bytes(
               Bmp{width, 1, bits, compression, header, std::move(masks), {}, std::move(pixels)}.file())
        .image;
}

}  // namespace

TEST_CASE("BMP: every header gives the same four colours") {
    for (const std::uint32_t header : {12u, 16u, 20u, 40u, 48u, 52u, 56u, 64u, 108u, 124u}) {
        INFO(header);
        Bmp bmp;
        bmp.header = header;
        bmp.pixels = four_colors();
        const ReadImage read = read_bytes(bmp.file());
        CHECK(codes(read.image) == kFour);
        CHECK(read.image.channel_names == Names{"R", "G", "B"});
        CHECK(read.image.sample_type == SampleType::kUint8);
        CHECK(read.warnings.empty());
    }
    for (const std::uint32_t header : {0u, 11u, 13u, 65u, 107u, 125u, 0xFFFFFFFFu}) {
        Bmp bmp;
        FileBytes file = bmp.file().zeros(200);
        for (int i = 0; i < 4; ++i)
            file.bytes[14 + static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(header >> (8 * i));
        CHECK(refusal(file)->kind() == ErrorKind::kBadFile);
    }
}

TEST_CASE("BMP: rows from the top, an array of bitmaps, and the place of the pixels") {
    Bmp bmp;
    bmp.pixels = four_colors();
    bmp.height = -2;
    CHECK(codes(read_bytes(bmp.file()).image) == Codes{0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0});
    bmp.height = 2;
    FileBytes array("BA");
    bmp.offset = 68;  // in the whole file
    array.little(40, 4).little(0, 4).little(0, 4).put(bmp.file());
    CHECK(codes(read_bytes(array).image) == kFour);
    bmp.palette.zeros(20);  // behind 24 bits a palette is for screens of few colours
    bmp.offset = 74;
    CHECK(codes(read_bytes(bmp.file()).image) == kFour);
    bmp.palette.bytes.clear();
    for (const std::uint32_t inside : {0u, 5u, 53u}) {
        bmp.offset = inside;
        CHECK(codes(read_bytes(bmp.file()).image) == kFour);
        CHECK(read_bytes(bmp.file()).warnings.size() == (inside == 0 ? 0 : 1));
    }
}

TEST_CASE("BMP: indices of 1, 2, 4 and 8 bits") {
    // 3 x 2 pixels; the bottom row has indices 1 0 1, the top one 0 1 1.
    const std::pair<int, FileBytes> rows[] = {{1, FileBytes().put({0xA0, 0, 0, 0, 0x60, 0, 0, 0})},
                                              {2, FileBytes().put({0x44, 0, 0, 0, 0x14, 0, 0, 0})},
                                              {4, FileBytes().put({0x10, 0x10, 0, 0, 0x01, 0x10, 0, 0})},
                                              {8, FileBytes().put({1, 0, 1, 0, 0, 1, 1, 0})}};
    for (const auto& row : rows) {
        INFO(row.first);
        Bmp bmp{3, 2, row.first, 0, 40, {}, three_colors(), row.second, 2};
        CHECK(codes(read_bytes(bmp.file()).image) ==
              Codes{0, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0, 0, 0, 0, 255, 0, 0});
        bmp.header = 12;
        bmp.palette = FileBytes().put({10, 10, 10, 200, 200, 200});
        const Image grey = read_bytes(bmp.file()).image;
        CHECK(grey.channel_names == Names{"Y"});
        CHECK(codes(grey) == Codes{10, 200, 200, 200, 10, 200});
    }
}

TEST_CASE("BMP: palettes that are too short, too long, or not there") {
    Bmp bmp{3, 1, 8, 0, 40, {}, three_colors(), FileBytes().put({1, 3, 200, 0}), 3};
    const ReadImage read = read_bytes(bmp.file());
    CHECK(codes(read.image) == Codes{255, 0, 0, 0, 0, 0, 0, 0, 0});
    CHECK(read.warnings ==
          Warnings{"pixels with an index beyond the palette's 3 colours, which are black: 2"});
    bmp.colors = 0;  // 256, but the pixels begin after three
    CHECK(codes(read_bytes(bmp.file()).image) == codes(read.image));
    bmp.colors = 4000000000;
    CHECK(codes(read_bytes(bmp.file()).image) == codes(read.image));
    bmp.colors = 3;
    bmp.offset = 54;  // where the palette is
    CHECK(codes(read_bytes(bmp.file()).image) == codes(read.image));
    CHECK(read_bytes(bmp.file()).warnings.size() == 2);
    bmp.palette.bytes.clear();
    CHECK(refusal(bmp.file())->kind() == ErrorKind::kBadFile);
}

TEST_CASE("BMP: the fourth byte is alpha only where the header says so") {
    // One opaque red pixel, one green with alpha 128.
    const FileBytes pixels = FileBytes().put({0, 0, 255, 255, 0, 255, 0, 128});
    const std::vector<std::uint32_t> bgr = {0xFF0000, 0xFF00, 0xFF},
                                     bgra = {0xFF0000, 0xFF00, 0xFF, 0xFF000000};
    const Codes opaque = {255, 0, 0, 0, 255, 0}, alpha = {255, 0, 0, 255, 0, 255, 0, 128};
    CHECK(codes(masked(32, {}, pixels, 2, 40, 0)) == opaque);
    CHECK(codes(masked(32, {}, pixels, 2, 124, 0)) == opaque);
    CHECK(codes(masked(32, bgr, pixels, 2, 40, 3)) == opaque);
    CHECK(codes(masked(32, bgra, pixels, 2, 40, 6)) == alpha);
    CHECK(codes(masked(32, bgr, pixels, 2, 52, 3)) == opaque);
    CHECK(codes(masked(32, bgr, pixels, 2, 56, 3)) == opaque);
    for (const std::uint32_t header : {56u, 108u, 124u}) {
        CHECK(codes(masked(32, bgra, pixels, 2, header, 3)) == alpha);
        CHECK(codes(masked(32, bgra, pixels, 2, header, 0)) == alpha);  // as copied images are
    }
    // An alpha that is 0 everywhere is one that a writer has not filled in.
    const Bmp unfilled{1, 1, 32, 3, 56, bgra, {}, FileBytes().put({1, 2, 3, 0})};
    CHECK(codes(read_bytes(unfilled.file()).image) == Codes{3, 2, 1});
    CHECK(read_bytes(unfilled.file()).warnings == Warnings{"its alpha is 0 in every pixel and was left out"});
}

TEST_CASE("BMP: masks of any width and order are scaled to their own largest value") {
    CHECK(masked(16, {}, FileBytes().little(0x7C1F, 2).zeros(2), 1, 40, 0).data ==
          std::vector<float>{1, 0, 1});  // 5 bits each
    CHECK(masked(16, {0xF800, 0x7E0, 0x1F}, FileBytes().little(1 << 11 | 1 << 5 | 1, 2).zeros(2), 1).data ==
          std::vector<float>{1.0f / 31, 1.0f / 63, 1.0f / 31});
    CHECK(masked(16, {0xF00, 0xF0, 0xF, 0xF000}, FileBytes().little(0x8F31, 2).zeros(2), 1, 56).data ==
          std::vector<float>{1, 0.2f, 1.0f / 15, 8.0f / 15});
    CHECK(masked(16, {0x1, 0x2, 0x4}, FileBytes().little(5, 2).zeros(2), 1).data ==
          std::vector<float>{1, 0, 1});
    CHECK(masked(16, {0x7C00, 0x3E0, 0x1F, 0xFF000000}, FileBytes().little(0x1F, 2).zeros(2), 1, 56).data ==
          std::vector<float>{0, 0, 1});  // an alpha beyond the 16 bits is none
    CHECK(masked(24, {0xFF, 0xFF00, 0xFF0000}, FileBytes().put({255, 51, 0, 0}), 1).data ==
          std::vector<float>{1, 0.2f, 0});
    CHECK(masked(32, {0xFF000000, 0xFF0000, 0xFF00}, FileBytes().put({9, 0, 51, 255}), 1).data ==
          std::vector<float>{1, 0.2f, 0});
    CHECK(masked(16, {0xFF00, 0xFF, 0}, FileBytes().put({51, 255, 0, 0}), 1).data ==
          std::vector<float>{1, 0.2f, 0});  // a channel without bits
    const Image ten = masked(32, {0x3FF00000, 0xFFC00, 0x3FF}, FileBytes().little(1023u << 20 | 1, 4), 1);
    CHECK(ten.data == std::vector<float>{1, 0, 1.0f / 1023});
    CHECK(ten.sample_type == SampleType::kUint16);
    const Image sixteen = masked(32, {0xFFFF0000, 0xFFF0, 0xF}, FileBytes().little(0x8000FFF3, 4), 1);
    CHECK(sixteen.data == std::vector<float>{32768.0f / 65535, 1, 0.2f});
}

TEST_CASE("BMP: masks that no pixel can have are refused") {
    const auto why = [](int bits, std::vector<std::uint32_t> masks) -> std::string {
        const auto error = refusal(Bmp{1, 1, bits, 3, 40, std::move(masks), {}, FileBytes().zeros(4)}.file());
        REQUIRE(error);
        CHECK(error->kind() == ErrorKind::kBadFile);
        return error->what();
    };
    CHECK(why(32, {0xFF0000, 0x1FF00, 0xFF}).find("green overlaps") != std::string::npos);
    CHECK(why(32, {0xFF0000, 0xFF00, 0xF5}).find("blue has gaps") != std::string::npos);
    CHECK(why(16, {0x1F0000, 0x3E0, 0x1F}).find("red is beyond the 16 bits") != std::string::npos);
    CHECK(why(32, {0, 0, 0}).find("are all 0") != std::string::npos);
    CHECK(why(8, {1, 2, 4}).find("8 bits a pixel with compression 3") != std::string::npos);
}

TEST_CASE("BMP: runs of 8 bits, with every code") {
    Bmp bmp{4, 3, 8, 1, 40, {}, three_colors(), {}, 3};
    // Bottom row 1 1 1 1; middle row 2 1 2 and a pixel that is stepped over; top row: one right, then 2 1.
    bmp.pixels.put({4, 1, 0, 0, 0, 3, 2, 1, 2, 0, 0, 0, 0, 2, 1, 0, 1, 2, 1, 1, 0, 1});
    const ReadImage read = read_bytes(bmp.file());
    const auto color = [&](int x, int y) { return static_cast<int>(read.image.pixel(x, y)[0] * 255 + 0.5f); };
    const Codes red = {color(0, 2), color(3, 2), color(0, 1), color(1, 1), color(2, 1),
                       color(3, 1), color(0, 0), color(1, 0), color(2, 0), color(3, 0)};
    CHECK(red == Codes{255, 255, 100, 255, 100, 0, 0, 100, 255, 0});
    CHECK(read.warnings ==
          Warnings{"pixels that its runs step over, which have the palette's first colour: 3"});

    // The end is said, or it is where the last pixel is.
    bmp.height = 1;
    for (const auto& end :
         {FileBytes().put({0, 0, 0, 1}), FileBytes().put({0, 1}), FileBytes().put({0, 0}), FileBytes()}) {
        bmp.pixels = FileBytes().put({4, 1}).put(end);
        CHECK(codes(read_bytes(bmp.file()).image) == Codes{255, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0});
        CHECK(read_bytes(bmp.file()).warnings.empty());
    }
    for (const auto& cut : {FileBytes(), FileBytes().put({3, 1}), FileBytes().put({0}),
                            FileBytes().put({0, 4, 1, 1}), FileBytes().put({0, 2, 1})}) {
        bmp.pixels = cut;
        CHECK(refusal(bmp.file())->kind() == ErrorKind::kBadFile);
    }
    bmp.pixels = FileBytes().put({7, 1, 0, 1});  // as many decoders do: beyond a row nothing is drawn
    CHECK(codes(read_bytes(bmp.file()).image) == Codes{255, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0, 0});
    CHECK(read_bytes(bmp.file()).warnings ==
          Warnings{"pixels of its runs beyond a row, which were dropped: 3"});
    bmp.pixels = FileBytes().put({0, 2, 255, 255, 4, 1, 0, 1});
    CHECK(read_bytes(bmp.file()).warnings.size() == 1);
}

TEST_CASE("BMP: runs of 4 bits alternate two indices") {
    Bmp bmp{5, 2, 4, 2, 40, {}, three_colors(), {}, 3};
    bmp.pixels.put({5, 0x12, 0, 0, 0, 5, 0x01, 0x20, 0x10, 0, 0, 1});
    CHECK(codes(read_bytes(bmp.file()).image) ==
          Codes{0,   0, 0, 255, 0,   0,   100, 100, 100, 0,   0,   0,   255, 0, 0,    // 0 1 2 0 1
                255, 0, 0, 100, 100, 100, 255, 0,   0,   100, 100, 100, 255, 0, 0});  // 1 2 1 2 1
    bmp.palette = FileBytes().put({9, 9, 9, 0, 8, 8, 8, 0, 7, 7, 7, 0});
    CHECK(codes(read_bytes(bmp.file()).image) == Codes{9, 8, 7, 9, 8, 8, 7, 8, 7, 8});
}

TEST_CASE("BMP: missing pixels are an error, a missing padding is told") {
    Bmp bmp;
    bmp.pixels = four_colors();
    CHECK(read_bytes(bmp.file().without_last(2)).warnings ==
          Warnings{"the padding of its last row is missing"});
    CHECK(codes(read_bytes(bmp.file().without_last(2)).image) == kFour);
    CHECK(refusal(bmp.file().without_last(3))->kind() == ErrorKind::kBadFile);
    bmp.width = 40000;
    bmp.height = 6000;
    CHECK(refusal(bmp.file())->kind() == ErrorKind::kBadFile);  // before memory is taken
}

TEST_CASE("BMP: a PNG inside, and what is refused by name") {
    Bmp bmp;
    bmp.bits = 0;
    bmp.compression = 5;
    bmp.pixels.bytes = red_png();
    CHECK(codes(read_bytes(bmp.file()).image) == Codes{255, 0, 0});
    bmp.pixels.bytes = {0, 1, 2};
    CHECK(refusal(bmp.file())->kind() == ErrorKind::kBadFile);
    struct Case {
        int bits;
        std::uint32_t compression, header;
        const char* word;
    };
    for (const Case& c : {Case{1, 3, 64, "Huffman"},
                          {1, 3, 40, "Huffman"},
                          {24, 4, 64, "runs of 24 bits"},
                          {24, 4, 40, "runs of 24 bits"},
                          {64, 0, 124, "64 bits"},
                          {32, 11, 108, "compression 11"}}) {
        const auto error =
            refusal(Bmp{1, 1, c.bits, c.compression, c.header, {}, {}, FileBytes().zeros(8)}.file());
        REQUIRE(error);
        CHECK(error->kind() == ErrorKind::kUnsupported);
        CHECK(std::string(error->what()).find(c.word) != std::string::npos);
    }
    CHECK(refusal(FileBytes("BACI").zeros(100))->kind() == ErrorKind::kUnsupported);
}

TEST_CASE("BMP: the colour space of versions 4 and 5") {
    const auto read = [](std::uint32_t header, std::uint32_t type, const FileBytes& more,
                         const FileBytes& behind = {}) {
        Bmp bmp;
        bmp.header = header;
        bmp.masks = {0, 0, 0, 0, type};
        for (std::size_t i = 0; i + 4 <= more.bytes.size(); i += 4)
            bmp.masks.push_back(
                static_cast<std::uint32_t>(more.bytes[i] | more.bytes[i + 1] << 8 | more.bytes[i + 2] << 16) |
                static_cast<std::uint32_t>(more.bytes[i + 3]) << 24);
        bmp.pixels = four_colors().put(behind);
        return read_bytes(bmp.file());
    };
    CHECK(read(124, 0x73524742, {}).image.color_space == ColorSpace::kSrgb);
    CHECK(read(108, 0, {}).image.color_space == ColorSpace::kSrgb);  // nothing is stated
    FileBytes p3;  // x, y, z of Display P3's primaries in 2.30, then a gamma of 2.2 in 16.16
    for (const double part : {0.68, 0.32, 0.0, 0.265, 0.69, 0.045, 0.15, 0.06, 0.79})
        p3.little(static_cast<std::uint32_t>(part * (1 << 30)), 4);
    FileBytes rec709;
    for (const double part : {0.64, 0.33, 0.03, 0.30, 0.60, 0.10, 0.15, 0.06, 0.79})
        rec709.little(static_cast<std::uint32_t>(part * (1 << 30)), 4);
    const FileBytes gamma = FileBytes().little(144179, 4).little(144179, 4).little(144179, 4);
    CHECK(read(108, 0, FileBytes().put(rec709).put(gamma)).image.color_space == ColorSpace::kGamma22);
    CHECK(codes(read(108, 0, FileBytes().put(rec709).put(gamma)).image) == kFour);
    CHECK(read(108, 0, p3.put(gamma)).image.color_space != ColorSpace::kGamma22);
    CHECK(read(124, 0x4C494E4B, {}).warnings.size() == 1);  // a profile in another file
    CHECK(read(124, 0x4D424544, FileBytes().zeros(52).little(124 + 16, 4).little(3, 4)).warnings.size() == 1);
    // Three bytes behind the pixels are a profile, though a broken one.
    const auto broken =
        read(124, 0x4D424544, FileBytes().zeros(52).little(124 + 16, 4).little(3, 4), FileBytes("abc"));
    REQUIRE(broken.warnings.size() == 1);
    CHECK(broken.warnings[0].find("profile is broken") != std::string::npos);
}
