// The mesh that edges collapse in, and what holds for every collapse of a run.
#pragma once

#include <limits>
#include <vector>

#include "libcore/mesh/ring_mesh.h"
#include "libcore/simplify/kernel/mask_boundary.h"
#include "libcore/simplify/kernel/shape_limits.h"
#include "libcore/simplify/quadrics/quadric_sources.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// A mesh with what its vertices carry.
template <class Q>
struct QuadricMesh {
    RingMesh rings;
    std::vector<Q> quadrics;
    std::vector<Id> pixel;  ///< the number in the grid mesh of each vertex; empty where it is the same
};

struct SimplifyRules {
    const SimplifyParams& params;
    const SimplifyHooks& hooks;
    int channels;  ///< of the quadrics
    ShapeLimits limits;
    MaskBoundary* boundary = nullptr;  ///< of a masked image
    bool sides_decided = false;  ///< vertices of a side that are no corners go (GridMesh::side_vertices)
    float max_increment = std::numeric_limits<float>::infinity();
    double max_error = std::numeric_limits<double>::infinity();
};

}  // namespace imgmesh
