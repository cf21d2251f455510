// A side of a tile, from its own pixels alone: so the tiles on both of its sides find the same, whoever makes
// them, in any order (docs/decisions/0051-tile-sets.md).
#pragma once

#include <functional>
#include <span>

#include "libcore/mesh/tile_sides.h"

namespace imgmesh {

struct SideParams {
    double threshold = 0;  ///< of the collapse: SimplifyTarget::max_increment [feature^2 px^2]
    double smoothness =
        20;  ///< of the shifts, as RelaxParams::smoothness [feature^2 / px^2]; 0: all pixels rest
    double gouraud_share = 0.1;  ///< weight of the drawing with resting pixels in the fit, as in FitParams
    /// Makes the features of a vertex what a container holds; in place.
    std::function<void(float*)> round = {};
};

/// Returns the vertices of a line of pixels, their least-squares features, and the places of the pixels. A
/// line of one pixel has one vertex.
///
/// line  the pixels, `channels` features each, interleaved
Side simplify_side(std::span<const float> line, int channels, const SideParams& params);

/// Returns the side of a tile of the next level: the sides of two tiles end to end, with about half of their
/// vertices. The pixels have no places any more.
///
/// parts  one or two sides in their order, the last vertex of the first is the first of the second; numbers
/// of
///        pixels in the result go on from one to the next
Side coarser_side(std::span<const Side> parts, int channels);

}  // namespace imgmesh
