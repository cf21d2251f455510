// A mesh as the optimiser takes and gives it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "libcore/base/types.h"
#include "libcore/optimize/fan_fit.h"

namespace imgmesh {

/// The points where vertices may be: columns lie `step` apart, except that the last one lies at the centres
/// of the last pixels; rows alike.
struct PlaceGrid {
    int width = 2, height = 2;   ///< of the image [pixels], each at least 2
    int step = kPlacesPerPixel;  ///< >= 1

    int right() const { return kPlacesPerPixel * (width - 1); }
    int bottom() const { return kPlacesPerPixel * (height - 1); }
    int columns() const { return (right() + step - 1) / step + 1; }
    int rows() const { return (bottom() + step - 1) / step + 1; }
    int x(int column) const { return std::min(column * step, right()); }
    int y(int row) const { return std::min(row * step, bottom()); }
    int column(int x) const { return x == right() ? columns() - 1 : x / step; }
    int row(int y) const { return y == bottom() ? rows() - 1 : y / step; }
};

/// Faces run counter-clockwise on screen: each has a positive area. Colours are in grey levels 0 to 255, or
/// L*u*v*.
struct PlacedMesh {
    std::vector<Spot> spot;           ///< size V
    std::vector<std::uint8_t> fixed;  ///< size V: bits of fixed_axes.h
    std::vector<Face> faces;          ///< size F
};

}  // namespace imgmesh
