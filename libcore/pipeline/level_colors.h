// The features of a finished level as readers get them. Internal to the pipeline.
#pragma once

#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"

namespace imgmesh {

/// Turns features into what a reader gets: colours without their weight and on the colours' grid, other
/// channels in their own unit.
void take_weights_out(BaseMesh& mesh, const FeatureSpace& space);

/// Least squares overshoots beside edges. An alpha above 1 or below 0 means nothing, so the vertices' stays
/// between the least and the largest of the image.
void limit_alpha(BaseMesh& mesh, const FeatureImage& feature, const FeatureSpace& space, const Mask& mask);

}  // namespace imgmesh
