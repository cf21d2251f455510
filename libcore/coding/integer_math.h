// Arithmetic that decoders repeat exactly: whole numbers, whose sizes also suit doubles (below 2^53).
#pragma once

#include <cmath>
#include <cstdint>

namespace imgmesh::coding {

/// Returns the largest whole number that is not above numerator / divisor; divisor > 0.
constexpr std::int64_t floor_divide(std::int64_t numerator, std::int64_t divisor) {
    const std::int64_t quotient = numerator / divisor;
    return quotient - (quotient * divisor > numerator);
}
/// Returns the nearest whole number to numerator / divisor, halves upwards; divisor > 0.
constexpr std::int64_t rounded_divide(std::int64_t numerator, std::int64_t divisor) {
    return floor_divide(2 * numerator + divisor, 2 * divisor);
}
/// Returns the largest whole number whose square is not above `number`, which is below 2^52: IEEE roots are
/// correctly rounded, and those of such numbers keep whole roots apart from others.
inline std::int64_t floor_root(std::int64_t number) {
    return static_cast<std::int64_t>(std::sqrt(static_cast<double>(number)));
}

/// Returns 256 log2(number), number >= 1: the power of two, then a table of 16 parts with straight lines.
int log2_of(std::uint64_t number);
/// Returns 2^14 2^(-t / 1024) for t >= 0, in the same way; 0 from t = 14 * 1024.
std::int32_t half_power(std::int32_t t);

}  // namespace imgmesh::coding
