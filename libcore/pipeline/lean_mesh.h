// Meshes of fewer bytes: positions and colours on coarser grids, as MeshPrecision and two parameters choose.
#pragma once

#include <cstddef>

#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/param/fit_map.h"
#include "libcore/pipeline/build.h"
#include "libcore/pipeline/build_params.h"

namespace imgmesh {

/// Returns the step of positions of a mesh with that many vertices and meshed pixels: the parameter, else by
/// MeshPrecision [pixels].
double position_step(const BuildParams& params, std::int64_t pixels, std::size_t vertices);

/// The step of MeshPrecision::kCompact: a power of two, at most half a pixel and a sixteenth of the distance
/// of vertices, so that rounding costs the same share of the error at any density.
double compact_step(std::int64_t pixels, std::size_t vertices);

/// Rounds the colours of a mesh to levels of the sRGB curve. Unless fit.keep_colors, they are fitted again
/// among the levels. With fit.sides, those on sides stay as they are.
///
/// feature  the image, space.features() channels, in which the mesh's features are too
/// map      the mesh's, and `trivial` its trivial one, which has the weight fit.gouraud_share
/// return   how many levels they have: the parameter; else for kCompact the fewest, at least 64, with which
///          rounding adds about 1 % to the squared error of R, G and B through the map. 0 where colours stay
///          as they are: for kExact, HDR, no colour, and where 4096 levels are too few.
int round_colors(const BuildParams& params, BaseMesh& mesh, const FeatureImage& feature,
                 const FeatureSpace& space, const PixelMap& map, const PixelMap& trivial,
                 const FitParams& fit);

/// Says in the report that positions lie on kPositionStep alone, after they have been moved. Returns whether
/// some were on a coarser step.
bool forget_position_steps(BuildReport& report);

/// Makes the meshes of a finished mesh image compact: colours, unless HDR, get kCompactLevels, and positions
/// lie on compact_step(). With `keep_positions` they stay, as a pixel map needs whose pixels would move
/// along.
inline constexpr int kCompactLevels = 128;
void make_compact(MeshImage& mesh_image, bool keep_positions);

}  // namespace imgmesh
