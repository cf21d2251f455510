// A mesh as a coded file holds it: vertices on a grid, and a colour at each of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "libcore/base/index.h"

namespace imgmesh {

/// The grid of the vertices of a coded mesh. Its columns lie `step` quarter pixels apart, except that the
/// last one lies at the centres of the last pixels; rows alike. A side of one pixel counts as two.
struct CodedGrid {
    int width = 0, height = 0;  ///< of the image [pixels]
    int step = 4;               ///< >= 1 [quarter pixels]

    int right() const { return 4 * std::max(width - 1, 1); }    ///< x of the last column [quarter pixels]
    int bottom() const { return 4 * std::max(height - 1, 1); }  ///< y of the last row [quarter pixels]
    int columns() const { return (right() + step - 1) / step + 1; }
    int rows() const { return (bottom() + step - 1) / step + 1; }
    int x(int column) const { return std::min(column * step, right()); }
    int y(int row) const { return std::min(row * step, bottom()); }
};

/// A column and a row of the grid.
using GridPoint = std::array<std::int32_t, 2>;

/// The faces cover the whole rectangle of the grid, whose corners are vertices. They run counter-clockwise on
/// screen: each has a positive area. No two vertices are at one point.
struct CodedMesh {
    CodedGrid grid;
    int channels = 3;              ///< 1 to 4
    std::vector<GridPoint> point;  ///< size V
    std::vector<float> color;      ///< size V * channels, interleaved, in grey levels 0 to 255
    std::vector<Face> faces;       ///< size F

    std::size_t vertex_count() const { return point.size(); }
};

}  // namespace imgmesh
