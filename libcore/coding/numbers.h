// Whole numbers as bits that are as often 0 as 1.
#pragma once

#include <cstdint>

namespace imgmesh::coding {

inline constexpr std::uint32_t kEvenOdds = 1u << 14;

/// Codes the lowest `bits` bits of a number, the highest first.
template <class Coder>
std::uint32_t code_bits(Coder& coder, std::uint32_t number, int bits) {
    std::uint32_t out = 0;
    for (int i = bits; i-- > 0;) out = out << 1 | (coder.code((number >> i & 1) != 0, kEvenOdds) ? 1u : 0u);
    return out;
}

/// Codes a number below 2^31 by an exponential Golomb code (Teuhola 1978): cheapest around 2^order.
template <class Coder>
std::uint32_t code_number(Coder& coder, std::uint32_t number, int order) {
    const std::uint32_t wanted = (number >> order) + 1;
    int bits = 0;
    while (bits < 31 - order && coder.code(wanted >> (bits + 1) != 0, kEvenOdds)) ++bits;
    const std::uint32_t high = (1u << bits | code_bits(coder, wanted, bits)) - 1;
    return high << order | code_bits(coder, number, order);
}

}  // namespace imgmesh::coding
