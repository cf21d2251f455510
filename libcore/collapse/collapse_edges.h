// From the dense mesh to the base mesh by edge collapses in order of the quadric error (paper sec. 3.1
// and 3.2).
#pragma once

#include <cstdint>
#include <limits>

#include "libcore/base/progress.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/grid_mesh.h"

namespace imgmesh {

struct CollapseParams {
    std::int64_t target_vertices = 0;  ///< stop at this many vertices
    std::int64_t target_faces = 0;     ///< or at this many faces; whichever comes first
    double max_error =
        std::numeric_limits<double>::infinity();  ///< no collapse above this total quadric error
    float geometry_weight = 3.0f;                 ///< lambda, against colour [feature^2 / px^2]; > 0
    int smoothing = 2;  ///< passes of `smoothed` on the copy that gradients are taken from
};

struct CollapseResult {
    BaseMesh
        mesh;  ///< vertices in the order of the pixels that they descend from; positions on kPositionStep
    double error = 0;  ///< largest total quadric error of a merged vertex
    std::int64_t collapses = 0;
};

/// Collapses edges until a limit is reached or no edge may go. Every collapse keeps the mesh a triangulation
/// of the picture's rectangle: no face flips or degenerates, corners stay, sides stay straight. Vertices sit
/// at their quadric's minimiser wherever that is legal, else at the edge's midpoint or an end, whichever
/// costs least.
///
/// About 170 bytes a pixel; O(n). Three feature channels. Deterministic.
CollapseResult collapse_edges(const GridMesh& grid, const CollapseParams& params,
                              const Progress& progress = {});

}  // namespace imgmesh
