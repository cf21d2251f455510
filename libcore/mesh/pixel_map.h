// The pixel map: for every pixel its face of the base mesh and its position inside that face.
#pragma once

#include <utility>
#include <vector>

#include "libcore/base/grid.h"

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

/// One PixelCoord per pixel.
struct PixelMap : Grid<PixelCoord> {
    WeightPrecision precision = WeightPrecision::kFloat;  ///< the grid on which every weight is known to lie

    PixelMap() = default;
    PixelMap(int columns, int rows, std::vector<PixelCoord> coords,
             WeightPrecision known = WeightPrecision::kFloat)
        : Grid(columns, rows, std::move(coords)), precision(known) {}
};

}  // namespace imgmesh
