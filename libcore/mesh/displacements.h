// A pixel map as whole numbers: how far each pixel is moved on a grid of positions.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/image/mask.h"

namespace imgmesh {

/// The steps in a pixel where none are chosen: of 8, 16 and 32 the fewest that raise the RMS through the map
/// of photographs by less than 0.01 L*u*v* in the mean (docs/decisions/0034-compact-map.md).
inline constexpr int kUsualSteps = 16;

/// The displacement of every pixel of an image, in steps of the grid of positions: pixel (x, y) lies on the
/// mesh at (x + dx / steps, y + dy / steps). The position and the mesh decide the face and the weights
/// (docs/format.md), so displacements are all that has to be stored of such a map.
struct Displacements : GridSize {
    int steps = kUsualSteps;           ///< steps in a pixel: 8, 16 or 32
    std::vector<std::int16_t> dx, dy;  ///< size width * height [steps]; 0 outside the mask
    Mask inside;                       ///< pixels with a face; empty() for all

    bool operator==(const Displacements&) const = default;
};

}  // namespace imgmesh
