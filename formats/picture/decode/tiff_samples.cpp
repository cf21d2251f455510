#include "formats/picture/decode/tiff_samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace imgmesh {
namespace {

static_assert(std::endian::native == std::endian::little, "samples of 24 bits are read for these machines");

// Floats of fewer bits than 32, from their sign, exponent and mantissa.
float small_float(std::uint32_t code, int exponent_bits, int mantissa_bits) {
    const std::uint32_t mantissa = code & ((1u << mantissa_bits) - 1);
    const auto exponent = static_cast<int>((code >> mantissa_bits) & ((1u << exponent_bits) - 1));
    const int largest = (1 << exponent_bits) - 1, bias = largest / 2;
    const bool negative = ((code >> (exponent_bits + mantissa_bits)) & 1) != 0;
    float value = 0;
    if (exponent == largest)
        value = mantissa == 0 ? INFINITY : NAN;
    else if (exponent == 0)
        value = std::ldexp(static_cast<float>(mantissa), 1 - bias - mantissa_bits);
    else
        value =
            std::ldexp(static_cast<float>(mantissa | (1u << mantissa_bits)), exponent - bias - mantissa_bits);
    return negative ? -value : value;
}

std::uint32_t three_bytes(const std::uint8_t* at) {
    return at[0] | static_cast<std::uint32_t>(at[1]) << 8 | static_cast<std::uint32_t>(at[2]) << 16;
}

template <typename Number>
Number number_at(const std::uint8_t* at) {
    Number value{};
    std::memcpy(&value, at, sizeof value);
    return value;
}

float signed_code(std::uint32_t code, int bits) {
    const int unused = 32 - bits;
    return static_cast<float>(static_cast<std::int32_t>(code << unused) >> unused);
}

// Calls use(i, code) with the codes of a stream of bits.
template <typename Use>
void for_bits(const std::uint8_t* at, std::size_t count, int bits, Use&& use) {
    std::uint64_t held = 0;
    int have = 0;
    for (std::size_t i = 0; i < count; ++i) {
        for (; have < bits; have += 8) held = held << 8 | *at++;
        have -= bits;
        use(i, static_cast<std::uint32_t>((held >> have) & ((std::uint64_t{1} << bits) - 1)));
    }
}

template <typename Number>
void unpack_numbers(const std::uint8_t* at, std::size_t count, float* out, std::size_t step) {
    for (std::size_t i = 0; i < count; ++i, at += sizeof(Number))
        out[i * step] = static_cast<float>(number_at<Number>(at));
}

}  // namespace

void unpack_samples(std::span<const std::uint8_t> row, std::size_t count, TiffSamples kind, int bits,
                    float* out, std::size_t step) {
    const std::uint8_t* at = row.data();
    if (kind == TiffSamples::kFloat) {
        if (bits == 32) return unpack_numbers<float>(at, count, out, step);
        if (bits == 64) return unpack_numbers<double>(at, count, out, step);
        for (std::size_t i = 0; i < count; ++i)
            out[i * step] = bits == 16 ? small_float(number_at<std::uint16_t>(at + 2 * i), 5, 10)
                                       : small_float(three_bytes(at + 3 * i), 7, 16);
        return;
    }
    const bool negative = kind == TiffSamples::kSigned;
    switch (bits) {
        case 8:
            return negative ? unpack_numbers<std::int8_t>(at, count, out, step)
                            : unpack_numbers<std::uint8_t>(at, count, out, step);
        case 16:
            return negative ? unpack_numbers<std::int16_t>(at, count, out, step)
                            : unpack_numbers<std::uint16_t>(at, count, out, step);
        case 32:
            return negative ? unpack_numbers<std::int32_t>(at, count, out, step)
                            : unpack_numbers<std::uint32_t>(at, count, out, step);
        case 64:
            return negative ? unpack_numbers<std::int64_t>(at, count, out, step)
                            : unpack_numbers<std::uint64_t>(at, count, out, step);
        case 24:
            for (std::size_t i = 0; i < count; ++i) {
                const std::uint32_t code = three_bytes(at + 3 * i);
                out[i * step] = negative ? signed_code(code, bits) : static_cast<float>(code);
            }
            return;
        default:
            for_bits(at, count, bits, [&](std::size_t i, std::uint32_t code) {
                out[i * step] = negative ? signed_code(code, bits) : static_cast<float>(code);
            });
    }
}

}  // namespace imgmesh
