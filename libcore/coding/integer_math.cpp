#include "libcore/coding/integer_math.h"

#include <array>
#include <bit>
#include <cstddef>

#include "libcore/base/index.h"

namespace imgmesh::coding {
namespace {

// 256 log2(1 + i / 16), rounded.
constexpr std::array<std::int32_t, 17> kLog = {0,   22,  44,  63,  82,  100, 118, 134, 150,
                                               165, 179, 193, 207, 220, 232, 244, 256};
// 2^14 2^(-i / 16), rounded.
constexpr std::array<std::int32_t, 17> kPower = {16384, 15689, 15024, 14387, 13777, 13193,
                                                 12634, 12098, 11585, 11094, 10624, 10173,
                                                 9742,  9329,  8933,  8555,  8192};

}  // namespace

int log2_of(std::uint64_t number) {
    const int whole = as_int(std::bit_width(number)) - 1;
    const auto twelve =
        static_cast<std::int32_t>(whole >= 12 ? number >> (whole - 12) : number << (12 - whole));
    const std::size_t i = as_index(twelve >> 8 & 15);
    const std::int32_t part = twelve & 255;
    return 256 * whole + ((kLog[i] * (256 - part) + kLog[i + 1] * part + 128) >> 8);
}

std::int32_t half_power(std::int32_t t) {
    if (t >= 14 * 1024) return 0;
    const std::size_t i = as_index(t >> 6 & 15);
    const std::int32_t part = t & 63;
    return ((kPower[i] * (64 - part) + kPower[i + 1] * part) >> 6) >> (t >> 10);
}

}  // namespace imgmesh::coding
