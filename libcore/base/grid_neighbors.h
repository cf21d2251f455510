// Pixels that share a side.
#pragma once

#include "libcore/base/grid.h"

namespace imgmesh {

/// Calls visit(i, j) for the indices of every two pixels side by side or one above the other, i < j: pixel by
/// pixel, its right neighbour first, then the lower one.
template <typename Visit>
void for_neighbor_pixels(const GridSize& size, const Visit& visit) {
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            const std::size_t i = size.index(x, y);
            if (x + 1 < size.width) visit(i, i + 1);
            if (y + 1 < size.height) visit(i, i + as_index(size.width));
        }
}

}  // namespace imgmesh
