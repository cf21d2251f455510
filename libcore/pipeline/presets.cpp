#include "libcore/pipeline/presets.h"

namespace imgmesh {

// Each number is from the tables in docs/decisions/0013-defaults.md.
BuildParams preset_params(Preset preset) {
    BuildParams params;
    switch (preset) {
        case Preset::kFast:
            params.geometry_weight = 1;
            params.refine = 0;
            break;
        case Preset::kDefault:
            break;
        case Preset::kBest:
            params.geometry_weight = 0.1;
            params.rebuild_quadrics = true;
            params.refine = 6;
            params.exchange = 0.2;
            params.shape_weight = 0;
            break;
        case Preset::kFem:
            params.geometry_weight = 1;
            params.rebuild_quadrics = true;
            params.refine = 10;
            params.exchange = 0.2;
            params.shape_weight = 0.3;
            params.min_quality = 0.28;
            params.objective = Objective::kRgb;  // the mesh alone is what a simulation gets
            break;
    }
    return params;
}

}  // namespace imgmesh
