// Cells: parts of patches, which segmentation joins to regions.
#pragma once

#include <vector>

#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// An image cut into cells: 4-connected sets of pixels inside one patch. A patch is one cell unless the map
/// tears it or an outline cuts it. Regions are joined cells, so they are always connected.
struct Cells : Grid<Id> {  ///< each pixel's cell; kNone outside the mask
    std::vector<Id> face;  ///< each cell's face; cells are numbered by their first pixel, row by row

    using Grid::Grid;
    std::size_t count() const { return face.size(); }
};

/// Cuts the patches of a map into cells. Takes O(pixels) time.
Cells cut_cells(const PixelMap& map);

/// Cuts the patches also along the outlines of regions, which are numbers of pixels, of the map's size.
Cells cut_cells(const PixelMap& map, const Grid<Id>& regions);

}  // namespace imgmesh
