// Refinement of one level in the space whose error counts.
#pragma once

#include "libcore/pipeline/build.h"
#include "libcore/refine/refine.h"

namespace imgmesh {

/// `params.rounds` of refine() on a mesh and an image in L*u*v*. For Objective::kRgb both are taken to sRGB,
/// encoded, and the mesh back: the error is that of colours interpolated linearly in encoded sRGB. The mesh's
/// colours end as what the objective wants.
RefineReport refine_level(BaseMesh& mesh, const FeatureImage& feature, const Mask& mask, Objective objective,
                          RefineParams params, const Progress& progress);

}  // namespace imgmesh
