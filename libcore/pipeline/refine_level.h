// Refinement of one level in the colour space of its objective.
#pragma once

#include "libcore/base/progress.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/pipeline/build_params.h"

namespace imgmesh {

/// Runs `params.rounds` of refine(), or of optimize_mesh() if they exchange vertices and the image is no
/// strip one pixel wide, on a mesh and an image in L*u*v*. For Objective::kRgb both are converted to encoded
/// sRGB, and the mesh back. The error is then that of colours interpolated linearly in encoded sRGB. The mesh
/// gets the colours that are best for the objective.
void refine_level(BaseMesh& mesh, const FeatureImage& feature, const Mask& mask, Objective objective,
                  RefineParams params, const Progress& progress);

}  // namespace imgmesh
