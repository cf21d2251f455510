// Where a pixel map places a pixel.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Returns the point of the face `coord.face` with the weights of `coord`. `faces` and `position` are those
/// of a mesh, or other positions for its vertices [pixels]. The face must exist.
inline Vec2d mapped_position(const std::vector<Face>& faces, const std::vector<Vec2f>& position,
                             const PixelCoord& coord) {
    const auto [a, b, c] = faces[coord.face];
    const double u = coord.u, v = coord.v;
    return (1 - u - v) * position[a].cast<double>() + u * position[b].cast<double>() +
           v * position[c].cast<double>();
}

}  // namespace imgmesh
