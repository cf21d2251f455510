// From where pixels lie to weights that a container can hold, still without a fold.
#pragma once

#include <optional>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/param/relax.h"

namespace imgmesh {

/// The least twice-area of a stored pixel triangle [px^2]: far above what evaluation in single precision
/// loses.
inline constexpr double kLeastStoredArea = 0.01;

/// Weights of every pixel inside, rounded to the grid of `precision` so that they sum to one, and the pixel
/// triangles (both diagonals of each 2x2 cell) kept at kLeastStoredArea: pixels of a cell that rounding would
/// fold are moved to other nearby grid points. Nothing where that fails: some face is too large for weights
/// so coarse.
std::optional<PixelMap> quantize_map(const BaseMesh& mesh, const PixelEmbedding& pixels,
                                     const std::vector<FaceField>& fields, const std::vector<Face>& neighbors,
                                     WeightPrecision precision);

}  // namespace imgmesh
