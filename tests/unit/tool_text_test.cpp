#include <doctest/doctest.h>

#include <sstream>

#include "libcore/base/error.h"
#include "tools/common/did_you_mean.h"
#include "tools/common/numbers.h"
#include "tools/common/text.h"

using namespace imgmesh;

TEST_CASE("printable_line: printable text stays, everything else is escaped byte by byte") {
    CHECK(printable_line("photo.png: no \"picture\" \\ here") == "photo.png: no \"picture\" \\ here");
    CHECK(printable_line("süß 写真 🙂") == "süß 写真 🙂");
    CHECK(printable_line("a\nb\r\tc\x1b[0m\x7f") == "a\\x0ab\\x0d\\x09c\\x1b[0m\\x7f");
    CHECK(printable_line(std::string("a\0b", 3)) == "a\\x00b");
    CHECK(printable_line("\u0085\u2028\u2029") == "\\xc2\\x85\\xe2\\x80\\xa8\\xe2\\x80\\xa9");
}

TEST_CASE("printable_line: no name turns the direction of text or looks like another") {
    CHECK(printable_line("a\u202Egnp.exe") == "a\\xe2\\x80\\xaegnp.exe");
    for (const char* mark : {"\u061C", "\u200E", "\u202A", "\u2066", "\u2069", "\uFEFF", "\U000E0041"})
        CHECK(printable_line(mark).starts_with("\\x"));
    CHECK(printable_line("👩\u200D🚀") == "👩\u200D🚀");
}

TEST_CASE("printable_text and printable_json: lines stay, JSON means the same") {
    CHECK(printable_text("a\x1b\n\nb\x07") == "a\\x1b\n\nb\\x07");
    CHECK(printable_text("a\n") == "a\n");
    CHECK(printable_json("{\n\"\u009B\": \"\u202E\U000E0041ü\"}") ==
          "{\n\"\\u009b\": \"\\u202e\\udb40\\udc41ü\"}");
}

// Each of these is refused by the table of well-formed UTF-8 for another reason.
TEST_CASE("printable_line: ill-formed UTF-8") {
    CHECK(printable_line("\xff!") == "\\xff!");
    CHECK(printable_line("\x80!") == "\\x80!");                           // no lead byte
    CHECK(printable_line("\xc0\xaf!") == "\\xc0\\xaf!");                  // overlong
    CHECK(printable_line("\xe0\x80\xaf!") == "\\xe0\\x80\\xaf!");         // overlong
    CHECK(printable_line("\xed\xa0\x80!") == "\\xed\\xa0\\x80!");         // surrogate
    CHECK(printable_line("\xf4\x90\x80\x80") == "\\xf4\\x90\\x80\\x80");  // beyond U+10FFFF
    CHECK(printable_line("\xf0\x9f\x98") == "\\xf0\\x9f\\x98");           // cut off
    CHECK(printable_line("\xc3") == "\\xc3");
}

TEST_CASE("format_bytes: units of 1000, one decimal") {
    CHECK(format_bytes(0) == "0 B");
    CHECK(format_bytes(999) == "999 B");
    CHECK(format_bytes(1000) == "1.0 kB");
    CHECK(format_bytes(28345) == "28.3 kB");
    CHECK(format_bytes(999'949) == "999.9 kB");
    CHECK(format_bytes(999'950) == "1.0 MB");
    CHECK(format_bytes(5'000'000'000'000'000) == "5000.0 TB");
}

TEST_CASE("TextTable: values stand in one column") {
    TextTable table;
    table.add("size", "9 x 7");
    table.add("triangles", "two\nlines");
    std::ostringstream out;
    table.print(out, 2);
    CHECK(out.str() == "  size       9 x 7\n  triangles  two\\x0alines\n");
}

TEST_CASE("numbers: what is not wholly a number is none") {
    for (const char* text :
         {"", " 5", "5 ", "+5", "5k", "0x10", "1.5", "1e3", "four", "nan", "99999999999999999999"}) {
        INFO(text);
        CHECK_THROWS_AS(parse_count("--n", text, {}), Error);
    }
    for (const char* text :
         {"", " 5", "5 ", "+5", "5%", "0x1p3", "1,5", "1/30", "x", "nan", "inf", "1e400"}) {
        INFO(text);
        CHECK_THROWS_AS(parse_number("--x", text, {}), Error);
    }
}

TEST_CASE("parse_count: whole numbers, wholly read") {
    CHECK(parse_count("--faces", "2", {2}) == 2);
    CHECK(parse_count("--faces", "9223372036854775807", {2}) == std::numeric_limits<std::int64_t>::max());
    CHECK(parse_count("--n", "-3", {-5, 5}) == -3);
    CHECK_THROWS_WITH_AS(parse_count("--faces", "1e3", {2}),
                         "--faces '1e3': expected a whole number, at least 2", Error);
    CHECK_THROWS_WITH_AS(parse_count("--threads", "9", {1, 8}),
                         "--threads '9': expected a whole number from 1 to 8", Error);
}

TEST_CASE("parse_number: finite numbers, wholly read") {
    CHECK(parse_number("--error", "0", {0}) == 0);
    CHECK(parse_number("--error", "1.5e-3", {0}) == 1.5e-3);
    CHECK(parse_number("--density", "100", {0, 100, true}) == 100);
    CHECK_THROWS_WITH_AS(parse_number("--density", "0", {0, 100, true}),
                         "--density '0': expected a number above 0 and at most 100", Error);
    CHECK_THROWS_WITH_AS(parse_number("--error", "nan", {0}),
                         "--error 'nan': expected a number of at least 0", Error);
}

// A word for each kind of mistake: too many, missing, wrong and swapped letters, case, dashes, a beginning.
TEST_CASE("nearest_word: what was probably meant") {
    const std::vector<std::string> words = {"--faces", "--level-faces", "--levels", "--output",
                                            "--max-memory"};
    for (const auto& [typed, meant] :
         {std::pair("--facess", "--faces"), std::pair("--fces", "--faces"), std::pair("--fades", "--faces"),
          std::pair("--afces", "--faces"), std::pair("--FACES", "--faces"), std::pair("-faces", "--faces"),
          std::pair("--lev", "--levels"), std::pair("--level_faces", "--level-faces"),
          std::pair("--level", "--levels"), std::pair("--max-mem", "--max-memory")})
        CHECK(nearest_word(typed, words) == meant);
    for (const char* typed : {"", "--", "--x", "--frobnicate", "--fax", "--input-file"})
        CHECK(nearest_word(typed, words) == "");
    CHECK(nearest_word(std::string(100000, 'f'), words) == "");
    CHECK(nearest_word("x", {"y"}) == "");  // all of it would be wrong
    CHECK(did_you_mean("--fcaes", words) == "; did you mean --faces?");
    CHECK(did_you_mean("--far", {}) == "");
}

TEST_CASE("shortened: the beginning and the end of a text, in whole characters") {
    CHECK(shortened("abc", 3) == "abc");
    CHECK(shortened("abcdefghij", 9) == "abcd...ij");
    std::string text;
    for (int i = 0; i < 100; ++i) text += "é";
    for (std::size_t most = 8; most < 30; ++most) {
        const std::string cut = shortened(text, most);
        CHECK(cut.size() <= most);
        CHECK(cut.size() + 4 >= most);
        CHECK(printable_line(cut) == cut);  // which no part of a character is
    }
}
