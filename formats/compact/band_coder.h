// The coder of a band's displacements. Internal to this room.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace imgmesh {

/// Rows of displacements, width * rows each; `inside` is empty if all pixels are.
template <typename T, typename Flag>
struct BandOf {
    int width = 0;
    int rows = 0;
    std::span<T> dx, dy;
    std::span<Flag> inside;
};
using Band = BandOf<const std::int16_t, const std::uint8_t>;
using MutableBand = BandOf<std::int16_t, const std::uint8_t>;

/// Returns the bytes of a band.
std::vector<std::uint8_t> encode_band(const Band& band);
/// Fills a band; returns whether the bytes are a band of that size. Safe for any bytes.
bool decode_band(std::span<const std::uint8_t> bytes, const MutableBand& band);

}  // namespace imgmesh
