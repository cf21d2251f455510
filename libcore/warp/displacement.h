// The displacement field: how far every pixel moves.
#pragma once

#include <vector>

#include "libcore/image/image.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/solve_edits.h"

namespace imgmesh {

/// What a pixel does in a warp.
enum class PixelRole : std::uint8_t {
    kOutside,  ///< not drawn
    kGhost,    ///< beside the image's boundary: moves along with it, so the boundary is soft
    kInside    ///< drawn
};

/// The forward displacement of every pixel of a W x H image.
struct DisplacementField : GridSize {
    std::vector<Vec2f> move;      ///< size W * H [pixels]; 0 outside
    std::vector<PixelRole> role;  ///< size W * H

    bool has_mask = false;  ///< whether some pixels are not kInside
};

/// Moves each pixel as the corners of its face move, weighted by the pixel's three weights, summed over the
/// levels (paper sec. 4.2). Pixels whose corners do not move have exactly 0. If all three corners move alike,
/// the pixel has exactly their move. Pixels with a face in level 0 are kInside.
///
/// moves  one for each level of `mesh_image`, as solve_edits() returns them
///
/// The result is the same for any number of threads. Takes O(pixels) time for each level with moves.
DisplacementField displacement_field(const MeshImage& mesh_image, const std::vector<VertexMoves>& moves);

/// As displacement_field(mesh_image, solution.moves), but pixels move with the face that covers them where a
/// level has injective edits: through the pixel map, which follows edges of the image, pixels would fold on
/// faces that do not. Throws Error(kUnsupported) for faces of such a level that lie over one another.
DisplacementField edit_field(const MeshImage& mesh_image, const EditSolution& solution);

/// Gives pixels outside the mask a move, ring by ring outwards: the mean of their (up to eight) neighbours
/// that have one. The first ring becomes kGhost. A pixel outside whose own alpha is neither 0 nor 1 is a soft
/// boundary: it becomes kInside, and the ring goes around it. `alpha` (size W * H, or empty) becomes 0 for
/// pixels that stay outside. Without a mask nothing changes. warp_image() and inverse_map() do this
/// themselves.
void extend_outside(DisplacementField& field, std::vector<float>& alpha);

/// Returns the number of cells, each between four drawn pixels, that are turned over or have no area in some
/// part: there the warp folds. Takes O(pixels) time.
std::int64_t folded_cells(const DisplacementField& field);

/// Returns the top left pixels of these cells, ascending.
std::vector<std::size_t> list_folded_cells(const DisplacementField& field);

}  // namespace imgmesh
