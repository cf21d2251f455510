#include "libcore/pipeline/presets.h"

#include "libcore/base/error.h"

namespace imgmesh {
namespace {

BuildParams fast() {
    BuildParams params;
    params.geometry_weight = 1;
    params.refine = 0;
    params.map_rounds = 2;
    return params;
}

BuildParams best() {
    BuildParams params;
    params.geometry_weight = 0.1;
    params.rebuild_quadrics = true;
    params.refine = 7;
    params.exchange = 0.3;
    params.shape_weight = 0;
    return params;
}

BuildParams max() {
    BuildParams params = best();
    params.refine = 5;
    params.exchange = 1;
    params.anneal = 160;
    return params;
}

BuildParams small() {
    BuildParams params;
    params.map_steps = 8;
    params.map_rate = 0.5;
    params.mesh_precision = MeshPrecision::kCompact;
    return params;
}

BuildParams fem() {
    BuildParams params;
    params.geometry_weight = 1;
    params.rebuild_quadrics = true;
    params.refine = 3;
    params.exchange = 0.5;
    params.anneal = 80;
    params.shape_weight = 0.28;
    params.min_quality = 0.28;
    params.objective = Objective::kRgb;  // a simulation uses only the mesh
    return params;
}

}  // namespace

// Each number is from the tables in docs/decisions/0013-defaults.md.
const std::vector<Preset>& presets() {
    static const std::vector<Preset> all = {
        {"fast", "the shortest time, without refinement", fast()},
        {"default", "a low error through the pixel map, with triangles of good shape", {}},
        {"best", "a low error, with triangles as thin as a hundredth of their length (slow)", best()},
        {"max", "the lowest error, with triangles as thin (four times as slow as best)", max()},
        {"small", "the fewest bytes, for a few percent more error through the pixel map", small()},
        {"fem", "no triangle of bad shape, for numerical simulation", fem()},
    };
    return all;
}

const BuildParams& preset_params(std::string_view name) {
    for (const Preset& preset : presets())
        if (preset.name == name) return preset.params;
    throw Error(ErrorKind::kBadArgument, cat("'", name, "' is no preset"));
}

}  // namespace imgmesh
