#include <doctest/doctest.h>

#include <array>
#include <limits>
#include <vector>

#include "formats/files/byte_reader.h"
#include "formats/files/byte_writer.h"

using namespace imgmesh;

namespace {

constexpr std::array<std::uint8_t, 6> kBytes = {0x01, 0x02, 0x80, 0xFF, 0x00, 'x'};
constexpr std::size_t kHuge = std::numeric_limits<std::size_t>::max();

// Where EndOfBytes is thrown; kHuge where it is not.
template <typename Read>
std::size_t end_of(Read&& read) {
    try {
        read();
    } catch (const EndOfBytes& end) {
        return end.position;
    }
    return kHuge;
}

}  // namespace

TEST_CASE("byte reader: numbers of one to four bytes in both orders") {
    ByteReader big(kBytes, ByteOrder::kBig), little(kBytes, ByteOrder::kLittle);
    CHECK(big.number(1) == 0x01);
    CHECK(big.number(3) == 0x0280FF);
    CHECK(big.number(2) == 0x0078);
    CHECK(big.left() == 0);
    CHECK(little.number(4) == 0xFF800201u);
    CHECK(little.number(2) == 0x7800);
    CHECK(big.number_at(0, 4) == 0x010280FFu);
    CHECK(little.number_at(1, 3) == 0xFF8002u);
}

TEST_CASE("byte reader: the end is thrown with where the piece starts, and nothing is stepped over") {
    ByteReader in(kBytes, ByteOrder::kBig, 100);
    CHECK(in.position() == 100);
    CHECK(in.take(4).size() == 4);
    CHECK(end_of([&] { in.number(4); }) == 104);
    CHECK(end_of([&] { in.take(3); }) == 104);
    CHECK(end_of([&] { in.take(kHuge); }) == 104);
    CHECK(in.position() == 104);
    CHECK(in.take(2).size() == 2);
    CHECK(in.take(0).empty());
    CHECK(end_of([&] { in.take_if(0); }) == 106);
}

TEST_CASE("byte reader: a look elsewhere is 0 or false where not all of it is there") {
    const ByteReader in(kBytes, ByteOrder::kBig, 100);
    CHECK(in.number_at(104, 2) == 0x0078);
    for (const std::size_t position : {std::size_t{105}, std::size_t{106}, std::size_t{107}, kHuge, kHuge - 1,
                                       std::size_t{99}, std::size_t{0}})
        CHECK(in.number_at(position, 2) == 0);
    CHECK(in.has_at(105, "x"));
    CHECK(in.has_at(106, ""));
    CHECK_FALSE(in.has_at(105, "xy"));
    CHECK_FALSE(in.has_at(5, "x"));
    CHECK_FALSE(in.has_at(kHuge, "x"));
}

TEST_CASE("byte reader: text up to a zero byte, of at most so many bytes") {
    constexpr std::array<std::uint8_t, 6> kText = {'a', 'b', 0, 0, 'c', 'd'};
    ByteReader in(kText, ByteOrder::kBig);
    CHECK_FALSE(in.terminated_text(1).has_value());
    CHECK(in.position() == 0);
    CHECK(in.terminated_text(2) == "ab");
    CHECK(in.position() == 3);
    CHECK(in.take_if(0));
    CHECK_FALSE(in.take_if(0));
    CHECK_FALSE(in.terminated_text(kHuge).has_value());  // it does not end
    CHECK(in.position() == 4);
}

TEST_CASE("byte writer: what a reader gets back") {
    for (const ByteOrder order : {ByteOrder::kBig, ByteOrder::kLittle}) {
        std::vector<std::uint8_t> bytes;
        append_number(bytes, 0x12, 1, order);
        append_number(bytes, 0xABCDEF01u, 4, order);
        append_number(bytes, 0xFFFF1234u, 2, order);
        ByteReader in(bytes, order);
        CHECK(in.number(1) == 0x12);
        CHECK(in.number(4) == 0xABCDEF01u);
        CHECK(in.number(2) == 0x1234);
        CHECK(in.left() == 0);
    }
}
