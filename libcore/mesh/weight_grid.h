// Weights on the grid that a container holds (pixel_map.h).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// The number of grid steps in a weight of 1.
inline double weight_steps(WeightPrecision precision) {
    return 1.0 / (precision == WeightPrecision::kHalf ? kHalfWeightStep : kFloatWeightStep);
}

/// Rounds weights >= 0 of any positive sum to the nearest point of `face` on a grid with that many steps. It
/// uses largest remainders, so the three weights sum to one exactly. Weights of 0 stay 0 if the sum is 1.
inline PixelCoord on_weight_grid(Id face, const std::array<double, 3>& weight, double steps) {
    const double sum = weight[0] + weight[1] + weight[2];
    std::array<double, 3> whole{}, rest{};
    double left = steps;
    for (std::size_t k = 0; k < 3; ++k) {
        whole[k] = std::floor(weight[k] / sum * steps);
        rest[k] = weight[k] / sum * steps - whole[k];
        left -= whole[k];
    }
    for (; left > 0; --left) {
        const std::size_t k = as_index(std::max_element(rest.begin(), rest.end()) - rest.begin());
        ++whole[k];
        rest[k] = -1;
    }
    return {face, static_cast<float>(whole[1] / steps), static_cast<float>(whole[2] / steps)};
}

}  // namespace imgmesh
