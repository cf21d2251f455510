// The pixel map: for every pixel its face of the base mesh and its position inside that face.
#pragma once

#include <span>
#include <vector>

#include "libcore/base/types.h"

namespace imgmesh {

/// A point of the base mesh: a face (a, b, c) and the weights (1-u-v, u, v) of its corners, with u, v >= 0
/// and u + v <= 1.
struct PixelCoord {
    Id face = kNone;  ///< kNone for a pixel outside the mask; then u = v = 0
    float u = 0;      ///< weight of the second corner
    float v = 0;      ///< weight of the third corner

    bool operator==(const PixelCoord&) const = default;
};

/// The step of stored weights. Every weight, including the first corner's, is a multiple of it. So rotating a
/// face's corners loses nothing, and u + v <= 1 holds exactly (docs/format.md).
inline constexpr float kHalfWeightStep = 1.0f / 2048.0f;       ///< exact in a HALF
inline constexpr float kFloatWeightStep = 1.0f / 16777216.0f;  ///< exact in a FLOAT

enum class WeightPrecision { kHalf, kFloat };

/// One PixelCoord per pixel, rows from top to bottom.
struct PixelMap {
    int width = 0;
    int height = 0;
    std::vector<PixelCoord> coords;                       ///< size width * height
    WeightPrecision precision = WeightPrecision::kFloat;  ///< the grid on which every weight is known to lie

    std::span<const PixelCoord> row(int y) const {
        return {coords.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width),
                static_cast<std::size_t>(width)};
    }
    std::span<PixelCoord> row(int y) {
        return {coords.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width),
                static_cast<std::size_t>(width)};
    }
};

}  // namespace imgmesh
