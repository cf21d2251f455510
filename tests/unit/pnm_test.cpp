// Netpbm's files made by hand.
#include <doctest/doctest.h>

#include <bit>

#include "tests/support/file_bytes.h"

using namespace imgmesh;
using Codes = std::vector<int>;
using Floats = std::vector<float>;
using Names = std::vector<std::string>;
using Warnings = std::vector<std::string>;
using namespace std::string_view_literals;

namespace {

Image read(std::string_view text) {
    return read_bytes(FileBytes(text)).image;
}
bool is_broken(std::string_view text) {
    const auto error = refusal(FileBytes(text));
    return error && error->kind() == ErrorKind::kBadFile;
}
std::string little(float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    std::string out;
    for (int i = 0; i < 4; ++i) out += static_cast<char>(bits >> (8 * i));
    return out;
}
std::string big(float value) {
    const std::string bytes = little(value);
    return {bytes.rbegin(), bytes.rend()};
}

}  // namespace

TEST_CASE("PNM: bits as text, apart or together, and as bytes; 1 is black") {
    const Floats expected = {1, 0, 1, 0, 0, 1};
    CHECK(read("P1 3 2\n0 1 0\n1 1 0\n").data == expected);
    CHECK(read("P1\n3 2\n010110").data == expected);
    CHECK(read("P1\n3 2\n01\n0 11 # a comment 1 1\n0").data == expected);
    CHECK(read("P4\n3 2\n\x40\xC0").data == expected);
    CHECK(read("P4 10 1\n\x00\x40"sv).data == Floats{1, 1, 1, 1, 1, 1, 1, 1, 1, 0});
    CHECK(read("P1 1 1 1").channel_names == Names{"Y"});
    CHECK(is_broken("P1 3 2\n01011"));
    CHECK(is_broken("P1 3 2\n010112"));
    CHECK(is_broken("P4\n9 2\n\x40\xC0\x40"));
}

TEST_CASE("PNM: grey and colours as text and bytes") {
    CHECK(codes(read("P2 3 1 255 0 51\n255\n")) == Codes{0, 51, 255});
    CHECK(codes(read("P2 3 1 255 0 51 255")) == Codes{0, 51, 255});
    CHECK(codes(read("P3 1 2 255\n1 2 3  4 5 6")) == Codes{1, 2, 3, 4, 5, 6});
    CHECK(codes(read("P5 3 1 255\n\x01\x20\xFF")) == Codes{1, 32, 255});
    CHECK(codes(read("P6\n1\n2\n255\n\x01\x02\x03\x04\x05\x06")) == Codes{1, 2, 3, 4, 5, 6});
    CHECK(read("P6 1 1 255 abc").channel_names == Names{"R", "G", "B"});
    CHECK(is_broken("P2 3 1 255 0 51"));
    CHECK(is_broken("P2 3 1 255 0 x 1"));
    CHECK(is_broken("P2 3 1 255 0 -1 1"));
    CHECK(is_broken("P6 1 2 255 abcde"));
}

TEST_CASE("PNM: comments wherever they stand") {
    CHECK(codes(read("P2#one\n# two\n2 # three 7\n1\n# four\n255 # five\n1 # six\n2")) == Codes{1, 2});
    CHECK(codes(read("P5\n# by a program\n2 1\n255\n#\x02")) == Codes{'#', 2});  // pixels know no comments
    CHECK(codes(read("P5 2 1 255#note\n\x01\x02")) == Codes{1, 2});
    CHECK(codes(read("P5 1#2\n2 255\r\x0A\x02")) == Codes{10, 2});
}

TEST_CASE("PNM: any largest value to 65535") {
    CHECK(read("P2 3 1 5 0 1 5").data == Floats{0, 0.2f, 1});
    CHECK(read("P5 2 1 100\n\x19\x64").data == Floats{0.25f, 1});
    CHECK(read("P2 2 1 1000 1 1000").data == Floats{0.001f, 1});
    CHECK(read("P2 2 1 1000 1 1000").sample_type == SampleType::kUint16);
    CHECK(read("P5 2 1 256\n\x00\x40\x01\x00"sv).data == Floats{0.25f, 1});
    CHECK(read("P5 2 1 65535\n\x80\x01\xFF\xFF").data == Floats{32769.0f / 65535, 1});
    CHECK(read("P2 1 1 255 9").sample_type == SampleType::kUint8);
    for (const std::string_view wrong : {"P2 1 1 0 0", "P2 1 1 65536 0", "P2 1 1 99999999999999999999 0"})
        CHECK(is_broken(wrong));
    const ReadImage above = read_bytes(FileBytes("P2 3 1 100 100 101 999"));
    CHECK(above.image.data == Floats{1, 1, 1});
    CHECK(above.warnings ==
          Warnings{"samples above the file's largest value, 100, which were read as it: 2"});
}

TEST_CASE("PNM: headers that cannot be, and sizes that the file does not hold") {
    for (const std::string_view wrong :
         {"P5", "P5 ", "P5 2", "P5 2 1", "P5 2 1 255", "P5 0 1 255 ", "P5 -1 1 255 a", "P5 a 1 255 a",
          "P5 70000 1 255 a", "P5 60000 60000 255 a", "P3 16000 16000 255 1 2 3", "P1 16000 16000 1",
          "P4 16000 16000 1", "P5 999999999 999999999 65535 1"}) {
        INFO(wrong);
        CHECK(is_broken(wrong));
    }
    CHECK(codes(read("P5 1 1 255\nAP5 1 1 255\nB")) == Codes{'A'});  // the first of two
    CHECK(refusal(FileBytes("P7 332\n#END_OF_COMMENTS\n1 1 255\nA"))->kind() == ErrorKind::kUnsupported);
}

TEST_CASE("PFM: rows from the bottom, in both byte orders, times the scale") {
    const Image grey = read("Pf\n2 2\n-1.0\n" + little(1) + little(-2.5f) + little(1e9f) + little(0));
    CHECK(grey.data == Floats{1e9f, 0, 1, -2.5f});
    CHECK(grey.channel_names == Names{"Y"});
    CHECK(grey.sample_type == SampleType::kFloat);
    CHECK(grey.color_space == ColorSpace::kLinear);
    CHECK(read("PF 1 1 2\n" + big(1) + big(0.5f) + big(-1)).data == Floats{2, 1, -2});
    CHECK(read("PF\n# note\n1 1\n-5e-1\n" + little(1) + little(2) + little(3)).data == Floats{0.5f, 1, 1.5f});
    CHECK(is_broken("Pf 1 1 0\nabcd"));
    CHECK(is_broken("Pf 1 1 nan\nabcd"));
    CHECK(is_broken("Pf 1 1 one\nabcd"));
    CHECK(is_broken("Pf 2 1 -1\nabcdabc"));
}

TEST_CASE("PAM: channels by the type, else by the depth") {
    const auto pam = [](int depth, const std::string& type, const std::string& pixels, int largest = 255) {
        return read(cat("P7\nWIDTH 1\n# note\nHEIGHT 1\nDEPTH ", depth, "\nMAXVAL ", largest, "\n", type,
                        "ENDHDR\n", pixels));
    };
    CHECK(codes(pam(1, "TUPLTYPE GRAYSCALE\n", "\x33")) == Codes{51});
    CHECK(codes(pam(1, "TUPLTYPE BLACKANDWHITE\n", "\x01", 1)) == Codes{255});  // 1 is white here
    CHECK(codes(pam(3, "TUPLTYPE RGB\n", "\x01\x02\x03")) == Codes{1, 2, 3});
    CHECK(pam(3, "", "abc").channel_names == Names{"R", "G", "B"});
    CHECK(pam(2, "TUPLTYPE GRAYSCALE_ALPHA\n", "ab").channel_names == Names{"Y", "A"});
    CHECK(pam(2, "TUPLTYPE BLACKANDWHITE_ALPHA\n", "\x01\x01", 1).channel_names == Names{"Y", "A"});
    const Image rgba = pam(4, "TUPLTYPE RGB_ALPHA\n", "\x01\x02\x03\x80");
    CHECK(rgba.channel_names == Names{"R", "G", "B", "A"});
    CHECK(codes(rgba) == Codes{1, 2, 3, 128});
    CHECK(pam(5, "TUPLTYPE spectrum\n", "abcde").channel_names == Names{"C0", "C1", "C2", "C3", "C4"});
    CHECK(pam(4, "TUPLTYPE RGB\n", "abcd").channel_names == Names{"R", "G", "B", "C3"});
    CHECK(codes(pam(4, "TUPLTYPE CMYK\n", {"\x00\xFF\x33\x00", 4})) == Codes{255, 0, 204});
    CHECK(pam(1, "TUPLTYPE GRAYSCALE\n", "\x01\xF4", 1000).data == Floats{0.5f});
    const auto text = [](const char* lines) { return cat("P7\n", lines, "ENDHDR\nabcd"); };
    CHECK(is_broken(text("WIDTH 1\nHEIGHT 1\nDEPTH 1\n")));
    CHECK(is_broken(text("WIDTH 1\nHEIGHT 1\nMAXVAL 255\n")));
    CHECK(is_broken(text("WIDTH 1\nHEIGHT 1\nDEPTH 2\nMAXVAL 255\nTUPLTYPE RGB\n")));
    CHECK(is_broken(text("WIDTH 1x\nHEIGHT 1\nDEPTH 1\nMAXVAL 255\n")));
    CHECK(is_broken(text("WIDE 1\nHEIGHT 1\nDEPTH 1\nMAXVAL 255\n")));
    CHECK(is_broken(text("WIDTH 5\nHEIGHT 1\nDEPTH 1\nMAXVAL 255\n")));
    CHECK(is_broken(text("WIDTH 9\nHEIGHT 9\nDEPTH 999999999\nMAXVAL 255\n")));
    CHECK(is_broken("P7\nWIDTH 1\nHEIGHT 1\n"));
}
