// Turns the places of pixels into weights that a container can hold, without a fold.
#pragma once

#include <optional>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/param/relax.h"

namespace imgmesh {

/// The least twice-area of a stored pixel triangle [px^2]: far above the rounding errors of single
/// precision.
inline constexpr double kLeastStoredArea = 0.01;

/// Returns the weights of every pixel inside, rounded to the grid of `precision` so that they sum to one. All
/// pixel triangles (both diagonals of each 2x2 cell) keep kLeastStoredArea: where rounding would fold a cell,
/// its pixels move to other nearby grid points. Returns nothing if that fails: some face is too large for
/// such coarse weights.
std::optional<PixelMap> quantize_map(const BaseMesh& mesh, const PixelEmbedding& pixels,
                                     const std::vector<FaceField>& fields, const std::vector<Face>& neighbors,
                                     WeightPrecision precision);

}  // namespace imgmesh
