// How far every pixel moves.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/solve_edits.h"

namespace imgmesh {

enum class PixelRole : std::uint8_t {
    kOutside,  ///< not drawn
    kGhost,    ///< beside the image's boundary: moves along with it, so that it has a soft edge
    kInside    ///< drawn
};

/// The forward displacement of every pixel of a W x H image.
struct DisplacementField {
    int width = 0;
    int height = 0;
    std::vector<Vec2f> move;      ///< size W * H [pixels]; 0 outside
    std::vector<PixelRole> role;  ///< size W * H

    bool has_mask = false;  ///< some pixels are not kInside

    std::size_t index(int x, int y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    }
};

/// A pixel moves as the corners of its face do, weighted by the pixel's three weights, summed over the levels
/// (paper sec. 4.2). Pixels that no level maps to moved vertices have exactly 0, and corners that all move
/// alike move the pixel exactly so. kInside where level 0 has a face.
///
/// moves  one a level of `mesh_image`, as solve_edits() gives them
DisplacementField displacement_field(const MeshImage& mesh_image, const std::vector<VertexMoves>& moves);

/// Gives pixels outside a way to go, ring by ring from the inside outwards: each the mean of its (up to
/// eight) neighbours that have one. One ring are ghosts; a pixel outside that the image's own alpha `alpha`
/// (size W * H, or empty) makes neither clear nor opaque belongs to a soft boundary, becomes kInside, and the
/// ring goes around it. The alpha of pixels becomes 0 where they stay outside. No effect without a mask.
void extend_outside(DisplacementField& field, std::vector<float>& alpha);

/// How many cells of four drawn pixels are turned over or lose their area somewhere.
std::int64_t folded_cells(const DisplacementField& field);

}  // namespace imgmesh
