// Integer samples and the floats that stand for them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace imgmesh {

/// code / 255 and code / 65535, correctly rounded; `out` has the size of `codes`. On all threads.
void floats_from_codes(std::span<const std::uint8_t> codes, std::span<float> out);
void floats_from_codes(std::span<const std::uint16_t> codes, std::span<float> out);

/// The nearest codes, halves up, of values clamped to [0, 1]; NaN is 0. On all threads.
std::vector<std::uint8_t> codes8_from_floats(std::span<const float> values);
std::vector<std::uint16_t> codes16_from_floats(std::span<const float> values);

}  // namespace imgmesh
