// What lies on the four sides of a tile that is part of a larger picture. It is decided by the pixels of each
// side alone, so that neighbouring tiles agree to the bit.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/base/grid.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// A line of pixels that two tiles share, from left to right or from top to bottom. Pixels are numbered from
/// the line's first one, 0.
struct Side {
    std::vector<int> vertices;    ///< pixels that are vertices, at their places, ascending, with both ends
    std::vector<float> features;  ///< of these vertices, interleaved, in feature space
    /// Of each pixel: how far its place is from it, along the line [pixels]. Multiples of 1/8, 0 at the ends;
    /// places ascend by at least 0.05. Empty: all are 0.
    std::vector<float> shifts;
};

struct TileSides {
    Side top, bottom, left, right;
};

/// Whether a place is on a side of the rectangle [0, width - 1] x [0, height - 1].
inline bool on_side(const Vec2f& place, int width, int height) {
    return place.x() == 0 || place.y() == 0 || place.x() == static_cast<float>(width - 1) ||
           place.y() == static_cast<float>(height - 1);
}

/// Returns for each vertex of a tile's mesh whether it is on a side of the tile's image.
std::vector<std::uint8_t> vertices_on_sides(const BaseMesh& mesh, const GridSize& image);

/// Gives the vertices on the sides the features that the sides have there, and returns whether all of them
/// are vertices of the sides.
bool set_side_features(BaseMesh& mesh, const TileSides& sides, const GridSize& image);

}  // namespace imgmesh
