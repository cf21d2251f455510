// TGA files made by hand, byte by byte.
#include <doctest/doctest.h>

#include "tests/support/tga_file.h"

using namespace imgmesh;
using Codes = std::vector<int>;
using Names = std::vector<std::string>;
using Warnings = std::vector<std::string>;

namespace {

// Red, green / blue, white as B G R.
FileBytes four_colors() {
    return FileBytes().put({0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255});
}
// The same with a fourth byte 255, 128, 0, 64.
FileBytes four_with_alpha() {
    return FileBytes().put({0, 0, 255, 255, 0, 255, 0, 128, 255, 0, 0, 0, 255, 255, 255, 64});
}
const Codes kFour = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};

ReadImage read(const Tga& tga) {
    return read_bytes(tga.file(), "a.tga");
}

}  // namespace

TEST_CASE("TGA: four origins, an identification, and a name or a footer that tells it") {
    Tga tga{.pixels = four_colors(), .id = "made by hand"};
    CHECK(codes(read(tga).image) == kFour);
    tga.descriptor = 0;
    CHECK(codes(read(tga).image) == Codes{0, 0, 255, 255, 255, 255, 255, 0, 0, 0, 255, 0});
    tga.descriptor = 0x10;
    CHECK(codes(read(tga).image) == Codes{255, 255, 255, 0, 0, 255, 0, 255, 0, 255, 0, 0});
    tga.descriptor = 0x30;
    CHECK(codes(read(tga).image) == Codes{0, 255, 0, 255, 0, 0, 255, 255, 255, 0, 0, 255});
    tga.descriptor = 0x20;
    CHECK(refusal(tga.file(), "a.bin")->kind() == ErrorKind::kBadFile);
    tga.attributes = 0;
    CHECK(codes(read_bytes(tga.file(), "a.bin").image) == kFour);
}

TEST_CASE("TGA: attribute bits decide whether the fourth byte is alpha, the extension before them") {
    const Codes alpha = {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 255, 255, 255, 64};
    Tga tga{.bits = 32, .pixels = four_with_alpha()};
    CHECK(codes(read(tga).image) == kFour);
    CHECK(read(tga).warnings.empty());
    tga.descriptor = 0x28;
    CHECK(codes(read(tga).image) == alpha);
    tga.attributes = 3;
    CHECK(codes(read(tga).image) == alpha);
    for (const int none : {0, 1, 2}) {
        tga.attributes = none;
        CHECK(codes(read(tga).image) == kFour);
        CHECK(read(tga).warnings == Warnings{"it says that its alpha is of no use, so it was left out"});
    }
    // Multiplied by alpha: 128 of 255 with alpha 128 is 255.
    tga.pixels = FileBytes().put({0, 0, 255, 255, 0, 128, 0, 128, 0, 0, 0, 0, 64, 64, 64, 64});
    tga.attributes = 4;
    CHECK(codes(read(tga).image) == Codes{255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 0, 0, 255, 255, 255, 64});
    tga = {.bits = 32, .descriptor = 0x28, .pixels = FileBytes().put({1, 2, 3, 0}), .width = 1, .height = 1};
    CHECK(codes(read(tga).image) == Codes{3, 2, 1});
    CHECK(read(tga).warnings == Warnings{"its alpha is 0 in every pixel and was left out"});
}

TEST_CASE("TGA: colours of 15 and 16 bits, with a bit of alpha where it is one") {
    const FileBytes pixels = FileBytes().little(0x8000 | 31 << 10, 2).little(16 << 5 | 1, 2);
    Tga tga{.bits = 15, .pixels = pixels, .height = 1};
    const std::vector<float> opaque = {1, 0, 0, 0, 16.0f / 31, 1.0f / 31};
    CHECK(read(tga).image.data == opaque);
    tga.bits = 16;
    CHECK(read(tga).image.data == opaque);
    tga.descriptor = 0x21;
    CHECK(read(tga).image.data == std::vector<float>{1, 0, 0, 1, 0, 16.0f / 31, 1.0f / 31, 0});
}

TEST_CASE("TGA: grey, and grey with alpha") {
    Tga tga{.type = 3, .bits = 8, .pixels = FileBytes().put({0, 51, 102, 255})};
    CHECK(codes(read(tga).image) == Codes{0, 51, 102, 255});
    CHECK(read(tga).image.channel_names == Names{"Y"});
    tga = {
        .type = 3, .bits = 16, .descriptor = 0x28, .pixels = FileBytes().put({10, 255, 20, 0}), .height = 1};
    CHECK(codes(read(tga).image) == Codes{10, 255, 20, 0});
    CHECK(read(tga).image.channel_names == Names{"Y", "A"});
    tga.descriptor = 0x20;
    CHECK(codes(read(tga).image) == Codes{10, 20});
}

TEST_CASE("TGA: palettes of every depth, from their first index") {
    struct Case {
        int bits;
        FileBytes palette;
    };
    // Index 5 is red, 6 is grey 132, which 5 bits hold, too.
    const Case cases[] = {{15, FileBytes().little(31 << 10, 2).little(16 << 10 | 16 << 5 | 16, 2)},
                          {16, FileBytes().little(31 << 10, 2).little(16 << 10 | 16 << 5 | 16, 2)},
                          {24, FileBytes().put({0, 0, 255, 132, 132, 132})},
                          {32, FileBytes().put({0, 0, 255, 0, 132, 132, 132, 9})}};
    for (const Case& c : cases) {
        INFO(c.bits);
        Tga tga{.type = 1, .bits = 8, .pixels = FileBytes().put({5, 6, 6, 5})};
        tga.palette_first = 5;
        tga.palette_size = 2;
        tga.palette_bits = c.bits;
        tga.palette = c.palette;
        CHECK(codes(read(tga).image) == Codes{255, 0, 0, 132, 132, 132, 132, 132, 132, 255, 0, 0});
        tga.pixels = FileBytes().put({4, 5, 6, 7});
        CHECK(codes(read(tga).image) == Codes{0, 0, 0, 255, 0, 0, 132, 132, 132, 0, 0, 0});
        CHECK(read(tga).warnings ==
              Warnings{"pixels with an index beyond the palette's 2 colours, which are black: 2"});
        tga.bits = 16;
        tga.pixels = FileBytes().put({5, 0, 6, 0, 6, 0, 5, 0});
        CHECK(codes(read(tga).image) == Codes{255, 0, 0, 132, 132, 132, 132, 132, 132, 255, 0, 0});
        if (c.bits != 32) continue;
        tga.descriptor = 0x28;
        CHECK(codes(read(tga).image) ==
              Codes{255, 0, 0, 0, 132, 132, 132, 9, 132, 132, 132, 9, 255, 0, 0, 0});
    }
    Tga behind{.pixels = four_colors()};  // colours with a palette that nothing needs
    behind.palette_size = 2;
    behind.palette_bits = 24;
    behind.palette.put({1, 2, 3, 4, 5, 6});
    CHECK(codes(read(behind).image) == kFour);
}

TEST_CASE("TGA: runs that cross rows, and pixels beyond the image") {
    Tga tga{.type = 10, .pixels = FileBytes().put({0x82, 0, 0, 255, 0, 255, 255, 255})};
    CHECK(codes(read(tga).image) == Codes{255, 0, 0, 255, 0, 0, 255, 0, 0, 255, 255, 255});
    tga.pixels = FileBytes().put({0, 0, 0, 255, 0xFF, 0, 255, 0});  // the last run is far too long
    CHECK(codes(read(tga).image) == Codes{255, 0, 0, 0, 255, 0, 0, 255, 0, 0, 255, 0});
    tga.pixels = FileBytes().put({3}).put(four_colors());
    CHECK(codes(read(tga).image) == kFour);
    CHECK(refusal(tga.file().without_last(1), "a.tga")->kind() == ErrorKind::kBadFile);
    tga.pixels = FileBytes().put({0x81, 0, 0, 255});
    CHECK(refusal(tga.file(), "a.tga")->kind() == ErrorKind::kBadFile);
    tga = {.type = 11, .bits = 8, .pixels = FileBytes().put({0x82, 7, 0, 9})};
    CHECK(codes(read(tga).image) == Codes{7, 7, 7, 9});
    tga.type = 9;
    tga.palette_size = 10;
    tga.palette_bits = 24;
    tga.palette.zeros(21).put({1, 1, 1, 0, 0, 0, 2, 2, 2});
    CHECK(codes(read(tga).image) == Codes{1, 1, 1, 2});
}

TEST_CASE("TGA: what cannot be is refused before memory is taken") {
    const auto kind = [](const Tga& tga) { return refusal(tga.file(), "a.tga")->kind(); };
    CHECK(kind({.pixels = four_colors().without_last(1)}) == ErrorKind::kBadFile);
    CHECK(kind({.type = 0}) == ErrorKind::kBadFile);
    CHECK(kind({.type = 8}) == ErrorKind::kBadFile);
    CHECK(kind({.type = 1, .bits = 8}) == ErrorKind::kBadFile);  // no palette
    CHECK(kind({.bits = 8}) == ErrorKind::kBadFile);
    CHECK(kind({.type = 3, .bits = 24}) == ErrorKind::kBadFile);
    CHECK(kind({.width = 0}) == ErrorKind::kBadFile);
    CHECK(kind({.type = 10, .pixels = four_colors(), .width = 16000, .height = 16000}) ==
          ErrorKind::kBadFile);
    CHECK(kind({.type = 32}) == ErrorKind::kUnsupported);
    CHECK(kind({.descriptor = 0xA0, .pixels = four_colors()}) == ErrorKind::kUnsupported);
    CHECK(refusal(FileBytes().zeros(17), "a.tga")->kind() == ErrorKind::kBadFile);
}
