#include "tools/build_contradictions.h"

#include <string>

#include "libcore/base/error.h"
#include "libcore/pipeline/params.h"
#include "tools/common/options.h"

namespace imgmesh {
namespace {

// Names the source of the rounds: --refine, or else the preset.
std::string typed_rounds(const CLI::App& app, std::int64_t rounds) {
    const std::string refine = typed(app, {"--refine"});
    return refine.empty()
               ? cat(typed(app, {"--preset"}), " (", rounds, " rounds of refinement, --refine 0 for none)")
               : refine;
}

[[noreturn]] void refuse(const std::string& one, const std::string& other, const std::string& why) {
    throw Error(ErrorKind::kBadArgument, cat(one, " and ", other, ": ", why));
}

}  // namespace

void check_contradictions(const CLI::App& app, const BuildParams& p) {
    const std::string map = typed(app, {"--map"});
    const std::string projection = typed(app, {"--projection-color-weight", "--map-smoothness"});
    const std::int64_t rounds = p.refine.value_or(0);

    if (p.metric == Metric::kHoppe && given(app, "--geometry-weight"))
        refuse("--geometry-weight", "--metric hoppe", "that metric has no geometry to weigh");
    if (p.projection_color_weight == 0.0 && p.map.value_or(MapKind::kTrivial) != MapKind::kTrivial)
        refuse(map, projection, "a weight of 0 is the trivial map");
    if (p.projection_color_weight.value_or(0) > 0 && p.map == MapKind::kTrivial)
        refuse(map, projection, "the trivial map follows no colour");
    if (map_kind(p) == MapKind::kTracked && rounds > 0)
        refuse(map, typed_rounds(app, rounds), "a tracked map follows the collapse alone");
    if (map_kind(p) == MapKind::kTracked && (p.position_step || p.mesh_precision == MeshPrecision::kCompact))
        refuse(map, typed(app, {"--position-step", "--mesh-precision", "--preset"}),
               "a tracked map follows the collapse to where its vertices are");
    if (map_kind(p) == MapKind::kTracked && given(app, "--map-step"))
        refuse(map, "--map-step", "a tracked map puts pixels anywhere");
    if (map_kind(p) != MapKind::kRelaxed && given(app, "--map-rounds"))
        refuse(typed(app, {"--map", "--projection-color-weight"}), "--map-rounds",
               "only the relaxed map is made in rounds");
    if (map_kind(p) != MapKind::kRelaxed && given(app, "--map-rate"))
        refuse(typed(app, {"--map", "--projection-color-weight"}), "--map-rate",
               "only the relaxed map weighs bits against colour");
    if (p.values && p.color_levels) refuse("--values", "--color-levels", "values have no colours");
    if (p.values && given(app, "--texture"))
        refuse("--values", "--texture", "values are no colours that a texture could show");
    if (p.values && given(app, "--color-space"))
        refuse("--values", "--color-space", "values have no colour space");
    if (p.stop.rms && map_kind(p) == MapKind::kTracked)
        refuse(typed(app, {"--rms"}), map,
               "the RMS is searched over several meshes, a tracked map follows the collapse to one");
    if (p.stop.rms && p.visits)
        refuse(typed(app, {"--rms"}), "--visits",
               "the RMS is searched over several meshes, visits are those of the collapse to one");
    const std::string colors = typed(app, {"--colors"});
    if (p.quadric_colors && rounds > 0)
        refuse(colors, typed_rounds(app, rounds), "refinement fits colours of its own");
    if (p.quadric_colors && p.objective == Objective::kRgb)
        refuse(colors, typed(app, {"--objective", "--preset"}), "that objective fits colours of its own");
    const double lambda = p.geometry_weight / p.color_weight;
    if (!(lambda >= 1e-9 && lambda <= 1e9))
        throw Error(ErrorKind::kBadArgument,
                    cat(typed(app, {"--geometry-weight", "--color-weight"}),
                        ": geometry weight / color weight is ", lambda, ", expected 1e-9 to 1e9"));
    try {
        BuildParams levels;
        levels.levels = p.levels;
        check_params(levels);
    } catch (const Error& e) {
        throw Error(e.kind(),
                    cat(typed(app, {"--level-faces", "--level-errors", "--levels"}), ": ", e.what()));
    }
    check_params(p);
}

void check_no_map(const CLI::App& app, const BuildParams& p) {
    const char* const map = "--no-map";
    if (p.stop.rms) refuse(typed(app, {"--rms"}), map, "that error is the one through the pixel map");
    if (p.max_cluster)
        refuse(typed(app, {"--max-cluster"}), map, "the pixels of a face are those of the pixel map");
    for (const char* option : {"--map", "--projection-color-weight", "--map-smoothness", "--map-step",
                               "--map-rounds", "--map-rate", "--bary", "--visits"})
        if (given(app, option)) refuse(typed(app, {option}), map, "it is about the pixel map");
}

BuildParams without_map(BuildParams p) {
    p.map_is_left_out = true;
    if (map_kind(p) != MapKind::kRelaxed) return p;
    p.map = MapKind::kTrivial;
    p.projection_color_weight.reset();
    return p;
}

}  // namespace imgmesh
