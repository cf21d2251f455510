// Refinement of one level in the colour space of its objective.
#pragma once

#include "libcore/pipeline/build_params.h"
#include "libcore/refine/refine.h"

namespace imgmesh {

/// Runs `params.rounds` of refine() on a mesh and an image in L*u*v*. For Objective::kRgb both are converted
/// to encoded sRGB, and the mesh back. The error is then that of colours interpolated linearly in encoded
/// sRGB. The mesh gets the colours that are best for the objective.
RefineReport refine_level(BaseMesh& mesh, const FeatureImage& feature, const Mask& mask, Objective objective,
                          RefineParams params, const Progress& progress);

}  // namespace imgmesh
