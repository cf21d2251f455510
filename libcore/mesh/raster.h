// Finds the face of a base mesh that covers each point of a sampling grid, and the weights there.
#pragma once

#include <vector>

#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

/// Sample positions are multiples of this step [pixels]. Together with kPositionStep it makes every predicate
/// of the rasteriser exact in double, for images of up to 65536 pixels a side.
inline constexpr double kSampleStep = 1.0 / 16384.0;

/// The points (x[i], y[j]) at which a mesh is sampled, in source pixels. Both never fall.
struct SampleGrid {
    std::vector<double> x;
    std::vector<double> y;
    double scale = 1;  ///< samples per pixel; x[i] is near (i + 0.5) / scale - 0.5
};

/// Returns the pixel centres of a width x height image drawn `scale` times as large. Sample i is at (i + 0.5)
/// / scale - 0.5, moved into the mesh's domain [0, width-1] (for a side of one pixel [-0.5, 0.5]). There are
/// round(scale * side) samples a side, at least one. scale > 0; at 1 the samples are the pixel centres.
SampleGrid sample_grid(int width, int height, double scale);

/// Returns the face and weights of every sample, as a map of grid.x.size() x grid.y.size() "pixels".
///
/// A sample inside a face or on its edge belongs to the face; on shared edges to the lowest such face id. It
/// has kNone if no face covers it. This is exact for positions on the kPositionStep grid: a mesh without
/// holes covers its domain. Faces with signed_area2 <= 0 cover nothing. Weights are multiples of
/// kFloatWeightStep inside the simplex. The caller has checked that face corners are < vertex_count().
///
/// The result is the same for any number of threads. Time grows with samples + faces + rows of faces.
PixelMap rasterize(const BaseMesh& mesh, const SampleGrid& grid);

}  // namespace imgmesh
