// A build that stops at an error of the reconstruction. Internal to the pipeline.
#pragma once

#include "libcore/pipeline/build_stages.h"

namespace imgmesh {

/// Returns the level that StopParams::rms asks for. Sets limits.smoothing to that of its collapse.
void build_to_rms(const BuildStages& stages, SimplifyParams& limits, MeshImage& mesh_image);

}  // namespace imgmesh
