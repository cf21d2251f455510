// The connected parts of an image.
#pragma once

#include <vector>

#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grid_neighbors.h"

namespace imgmesh {

/// 4-connected parts, numbered from 0 by their first pixel, row by row.
struct ConnectedParts {
    Grid<Id> part;                   ///< of each pixel; kNone outside
    std::vector<std::size_t> first;  ///< the index of each part's first pixel
};

/// Joins neighbours i and j, both inside, for which alike(i, j) holds. inside(i) and alike(i, j) take indices
/// of pixels. Takes O(pixels) time.
template <typename Inside, typename Alike>
ConnectedParts connected_parts(const GridSize& size, const Inside& inside, const Alike& alike) {
    DisjointSets sets(size.pixel_count());
    for_neighbor_pixels(size, [&](std::size_t i, std::size_t j) {
        if (inside(i) && inside(j) && alike(i, j)) sets.join(as_id(i), as_id(j));
    });
    ConnectedParts parts{Grid<Id>(size, kNone), {}};
    for (std::size_t i = 0; i < parts.part.size(); ++i) {
        if (!inside(i)) continue;
        const Id first = sets.find(as_id(i));
        if (first == i) {
            parts.part[i] = as_id(parts.first.size());
            parts.first.push_back(i);
        } else {
            parts.part[i] = parts.part[first];
        }
    }
    return parts;
}

}  // namespace imgmesh
