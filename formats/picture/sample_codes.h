// Converts between integer samples and floats.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace imgmesh {

/// Writes code / 255 or code / 65535, correctly rounded; `out` has the size of `codes`. Uses all threads.
void floats_from_codes(std::span<const std::uint8_t> codes, std::span<float> out);
void floats_from_codes(std::span<const std::uint16_t> codes, std::span<float> out);

/// Writes the nearest codes, halves up, of values clamped to [0, 1]; NaN is 0. Uses all threads.
std::vector<std::uint8_t> codes8_from_floats(std::span<const float> values);
std::vector<std::uint16_t> codes16_from_floats(std::span<const float> values);

}  // namespace imgmesh
