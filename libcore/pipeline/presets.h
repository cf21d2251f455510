// Sets of parameters that were measured together (docs/decisions/0013-defaults.md).
#pragma once

#include "libcore/pipeline/build.h"

namespace imgmesh {

enum class Preset {
    kFast,     ///< no refinement
    kDefault,  ///< the lowest error through the map with well-shaped triangles: what BuildParams holds
    kBest,     ///< the lowest error of the mesh drawn alone, whatever the triangles' shape
    kFem       ///< refinement with a floor under the triangles' shape, for numerical simulation
};

BuildParams preset_params(Preset preset);

}  // namespace imgmesh
