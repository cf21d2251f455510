// What segmentation joins: the connected parts of patches.
#pragma once

#include <vector>

#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// An image cut into cells: sets of pixels, each 4-connected and inside one patch. A patch is one cell
/// unless the map tears it into several, so that regions, which are joined cells, are always connected.
struct Cells {
    int width = 0;
    int height = 0;
    std::vector<Id> of_pixel;  ///< size width * height: its cell, kNone outside the mask
    std::vector<Id> face;      ///< of each cell; cells are numbered by their first pixel, row by row

    std::size_t count() const { return face.size(); }
};

Cells cut_cells(const PixelMap& map);

}  // namespace imgmesh
