// A side of a tile, from its own pixels alone: so the tiles on both of its sides find the same, whoever makes
// them, in any order (docs/decisions/0051-tile-sets.md).
#pragma once

#include <span>

#include "libcore/mesh/tile_sides.h"

namespace imgmesh {

struct SideParams {
    double threshold = 0;  ///< of the collapse: SimplifyTarget::max_increment [feature^2 px^2]
    double smoothness =
        20;  ///< of the shifts, as RelaxParams::smoothness [feature^2 / px^2]; 0: all pixels rest
    double gouraud_share = 0.1;  ///< weight of the drawing with resting pixels in the fit, as in FitParams
};

/// Returns the vertices of a line of pixels, their least-squares features, and the places of the pixels. The
/// ends keep their own, as the sides of four tiles meet there. Colours are neither rounded nor clipped.
///
/// line  the pixels, `channels` features each, interleaved
Side simplify_side(std::span<const float> line, int channels, const SideParams& params);

/// Returns the side of a tile of the next level: `side` with half of its vertices. Its pixels have no places
/// any more.
Side coarser_side(const Side& side, int channels);

}  // namespace imgmesh
