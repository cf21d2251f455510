// The parameters of the collapse, which simplifies the dense mesh of all pixels to a base mesh.
#pragma once

#include <limits>

#include "libcore/simplify/metric.h"

namespace imgmesh {

/// Lambda with the lowest error through the pixel map after refinement (docs/decisions/0013-defaults.md).
inline constexpr double kUsualGeometryWeight = 0.3;

struct SimplifyParams {
    Metric metric = Metric::kFlattened;
    Solver solver = Solver::kClosed;
    /// lambda, against colour [feature^2 / px^2]; > 0; kHoppe has none
    float geometry_weight = static_cast<float>(kUsualGeometryWeight);
    int smoothing = 0;  ///< passes of `smoothed` on the copy that gradients are taken from
    /// quadrics are taken anew from the mesh whenever its vertices have nearly halved, instead of summed up
    /// from the pixels on
    bool rebuild_quadrics = false;
    bool total_priority = false;  ///< edges go by the total error (the paper), not by what a merge adds to it
    /// while the goal is far, edges go tile by tile, on all threads: faster, but seams show in the order. Not
    /// with SimplifyHooks::before.
    bool tiles = true;
    /// no new triangle larger than this [px^2]
    float max_face_area = std::numeric_limits<float>::infinity();
    /// nor of a lesser q = 4 sqrt(3) area / sum of squared edges (1 is best); 0 leaves only the guard against
    /// slivers
    float min_shape = 0;
};

}  // namespace imgmesh
