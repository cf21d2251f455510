#include "libcore/pipeline/param_table.h"

#include <initializer_list>
#include <sstream>

#include "libcore/image/color_levels.h"
#include "libcore/param/fit_map.h"
#include "libcore/param/track.h"
#include "libcore/pipeline/param_access.h"

namespace imgmesh {
namespace {

// Whether StopParams decide where the finest level ends.
bool stops(const BuildParams& p) {
    return !p.stop.rms && p.levels.faces.empty() && p.levels.errors.empty();
}

constexpr ParamListing kWhereGiven = {.when = "where given"};
constexpr ParamListing kWhereItStops = {"where it counts", stops};
constexpr ParamListing kRefined = {"with refinement",
                                   [](const BuildParams& p) { return p.refine.value_or(0) > 0; }};
constexpr ParamListing kAnnealed = {"where above 0", [](const BuildParams& p) { return p.anneal > 0; }};
constexpr ParamListing kDensity = {"where it counts", [](const BuildParams& p) {
                                       return stops(p) && !p.stop.faces && !p.stop.vertices && !p.stop.error;
                                   }};
constexpr ParamListing kLevels = {"where more than 1",
                                  [](const BuildParams& p) { return stops(p) && p.levels.count > 1; }};
constexpr ParamListing kGeometry = {"unless the metric is hoppe",
                                    [](const BuildParams& p) { return p.metric != Metric::kHoppe; }};
constexpr ParamListing kQuality = {"where above 0", [](const BuildParams& p) { return p.min_quality > 0; }};
constexpr ParamListing kValues = {"where given", [](const BuildParams& p) { return p.values; }};
constexpr ParamListing kCompact = {
    "where compact", [](const BuildParams& p) { return p.mesh_precision == MeshPrecision::kCompact; }};
constexpr ParamListing kVisits = {"where given", [](const BuildParams& p) { return p.visits; }};

constexpr ParamListing kOnGrid = {"unless the map is tracked",
                                  [](const BuildParams& p) { return map_kind(p) != MapKind::kTracked; }};
constexpr ParamListing kInRounds = {"if the map is relaxed",
                                    [](const BuildParams& p) { return map_kind(p) == MapKind::kRelaxed; }};
constexpr ParamListing kRate = {"where above 0", [](const BuildParams& p) { return p.map_rate > 0; }};

constexpr ParamListing kAsWeight = {"as projection-color-weight", [](const BuildParams&) { return false; }};

// The weight of colour in the map by its reciprocal, as decision 2 has it. The weight alone has a value.
NumberParam smoothness() {
    NumberParam kind;
    kind.range = {1e-9, 1e12};
    kind.get = [](const BuildParams&) { return std::nullopt; };
    kind.set = [](BuildParams& params, const double& value) { params.projection_color_weight = 1 / value; };
    return kind;
}

std::vector<Param> make_table() {
    using B = BuildParams;
    const auto stop = &B::stop;
    const auto levels = &B::levels;
    const NumberRange positive{0, kNoLimit, true}, any_error{0};
    const std::string image = "Image", size = "Size", pyramid = "Levels", simplification = "Simplification",
                      refinement = "Refinement", map = "Pixel map", precision = "Mesh precision";
    const std::vector<std::string> limits = {"faces", "vertices", "error", "density"};
    const auto with = [](std::vector<std::string> names, std::initializer_list<const char*> more) {
        names.insert(names.end(), more.begin(), more.end());
        return names;
    };
    return {
        {.name = "channels",
         .group = image,
         .kind = access<ChannelsParam>(&B::channels),
         .help = "Channels that the mesh follows, each perhaps with a weight, as in R,G,B,depth.Z:0.5",
         .otherwise = "the colour",
         .listed = kWhereGiven},
        {.name = "values",
         .group = image,
         .everyday = true,
         .kind = access<FlagParam>(&B::values),
         .help = "Images are data, as heights, not colours: numbers are those of the files, integers too, "
                 "nothing is clipped, and errors are in their unit",
         .listed = kValues},

        {.name = "density",
         .group = size,
         .everyday = true,
         .kind = number({0, 100, true}, stop, &StopParams::density),
         .help = "Number of vertices, in percent of the pixels",
         .listed = kDensity,
         .excludes = {"faces", "vertices", "error"}},
        {.name = "vertices",
         .group = size,
         .everyday = true,
         .kind = count({4}, stop, &StopParams::vertices),
         .help = "Number of vertices",
         .listed = kWhereItStops},
        {.name = "faces",
         .group = size,
         .everyday = true,
         .kind = count({2}, stop, &StopParams::faces),
         .help = "Number of faces",
         .listed = kWhereItStops},
        {.name = "error",
         .group = size,
         .kind = number(any_error, stop, &StopParams::error),
         .help =
             "Largest quadric error that a collapse may reach, as imgmesh-info tells it: some 20000 for 1 % "
             "of a photograph's pixels as vertices, 1000 for 5 %, 100 for 15 %",
         .listed = kWhereItStops},
        {.name = "rms",
         .group = size,
         .everyday = true,
         .kind = number(any_error, stop, &StopParams::rms),
         .help = "Largest RMS error of the reconstruction, in L*u*v*",
         .listed = kWhereGiven,
         .excludes = with(limits, {"levels", "level-faces", "level-errors"})},
        {.name = "max-cluster",
         .group = size,
         .kind = count({3}, &B::max_cluster),
         .help = "Largest number of pixels that one face may hold, whatever the other limits say",
         .listed = kWhereGiven},
        {.name = "min-quality",
         .group = size,
         .kind = number({0, 0.8}, &B::min_quality),
         .help = "Least shape of a triangle, 4 sqrt(3) area / sum of squared edges, whatever the other "
                 "limits say",
         .listed = kQuality},

        {.name = "levels",
         .group = pyramid,
         .everyday = true,
         .kind = count({1, kMaxLevels}, levels, &PyramidParams::count),
         .help = "Number of levels, each with a quarter of the faces of the one before",
         .listed = kLevels},
        {.name = "level-faces",
         .group = pyramid,
         .kind = counts({2}, levels, &PyramidParams::faces),
         .help = "Number of faces of each level, as in 8000,2000,500",
         .listed = kWhereGiven,
         .excludes = with(limits, {"levels"})},
        {.name = "level-errors",
         .group = pyramid,
         .kind = numbers(any_error, levels, &PyramidParams::errors),
         .help = "Largest quadric error of each level, as in 100,1000",
         .listed = kWhereGiven,
         .excludes = with(limits, {"levels", "level-faces"})},

        {.name = "metric",
         .group = simplification,
         .kind = words<Metric, Metric>(
             &B::metric, named({Metric::kFlattened, Metric::kHoppe, Metric::kGarland}, metric_name)),
         .help = "Error by which edges collapse and vertices are placed"},
        {.name = "solver",
         .group = simplification,
         .kind = words<Solver, Solver>(&B::solver,
                                       named({Solver::kSvd, Solver::kLu, Solver::kClosed}, solver_name)),
         .help = "How the place of least error is computed; closed is the fastest"},
        {.name = "geometry-weight",
         .group = simplification,
         .kind = number(positive, &B::geometry_weight),
         .help = "Weight of geometry in the quadrics",
         .listed = kGeometry},
        {.name = "color-weight",
         .group = simplification,
         .kind = number(positive, &B::color_weight),
         .help = "Weight of colour in the quadrics"},
        {.name = "smoothing",
         .group = simplification,
         .kind = count({0, kMaxSmoothing}, &B::smoothing),
         .help = "Smoothing passes before gradients are taken",
         .otherwise = "by density for the metric flattened, else 0"},
        {.name = "quadrics",
         .group = simplification,
         .kind = words<bool, bool>(&B::rebuild_quadrics, {{"accumulated", false}, {"rebuilt", true}}),
         .help = "Quadrics added up from the pixels on, or rebuilt from the mesh at every halving"},
        {.name = "priority",
         .group = simplification,
         .kind =
             words<std::optional<bool>, bool>(&B::total_priority, {{"increment", false}, {"total", true}}),
         .help = "Order of collapses, by the error that they add or by their total error",
         .otherwise = "increment for the metric flattened, else total"},
        {.name = "colors",
         .group = simplification,
         .kind = words<bool, bool>(&B::quadric_colors, {{"fitted", false}, {"quadric", true}}),
         .help = "Colours of vertices, fitted by least squares or those of the quadrics, as in the paper"},

        {.name = "refine",
         .group = refinement,
         .kind = count({0, kMaxRefine}, &B::refine),
         .help = "Rounds that move vertices, flip edges and relocate vertices to lower the error",
         .otherwise = cat(RefineParams().rounds, ", or 0 where refinement is not possible")},
        {.name = "shape-weight",
         .group = refinement,
         .kind = number({0}, &B::shape_weight),
         .help = "Weight of the triangles' shape against the error",
         .listed = kRefined},
        {.name = "exchange",
         .group = refinement,
         .kind = number({0, 1}, &B::exchange),
         .help =
             "Share of the vertices that each round adds, and removes elsewhere; slow, and for triangles as "
             "thin as a hundredth of their length",
         .listed = kRefined},
        {.name = "anneal",
         .group = refinement,
         .kind = count({0, kMaxAnneal}, &B::anneal),
         .help = "Sweeps of random moves after the exchanges, and then more exchanges; very slow",
         .listed = kAnnealed},
        {.name = "objective",
         .group = refinement,
         .kind =
             words<Objective, Objective>(&B::objective, {{"luv", Objective::kLuv}, {"rgb", Objective::kRgb}}),
         .help = "Error to lower, in L*u*v* or, for a mesh that is drawn without its map, in sRGB"},

        {.name = "map",
         .group = map,
         .kind = words<std::optional<MapKind>, MapKind>(&B::map, {{"relaxed", MapKind::kRelaxed},
                                                                  {"tracked", MapKind::kTracked},
                                                                  {"trivial", MapKind::kTrivial}}),
         .help = "How pixels find their places, fitted without folds, carried through every collapse as in "
                 "the paper, or left where they are",
         .otherwise = "relaxed"},
        {.name = "projection-color-weight",
         .group = map,
         .kind = number({0}, &B::projection_color_weight),
         .help = "Weight of colour in the pixel map; 0 makes the map trivial",
         .otherwise = cat(FitParams().color_weight, ", for a tracked map ", TrackParams().color_weight)},
        {.name = "map-smoothness",
         .group = map,
         .kind = smoothness(),
         .help = "Smoothness of the pixel map against colour, 1 / projection-color-weight",
         .otherwise =
             cat(1 / FitParams().color_weight, ", for a tracked map ", 1 / TrackParams().color_weight),
         .listed = kAsWeight,
         .excludes = {"projection-color-weight"}},
        {.name = "map-step",
         .group = map,
         .kind = words<int, int>(&B::map_steps, {{"1/32", 32}, {"1/16", 16}, {"1/8", 8}}),
         .help = "Grid on which pixels lie on the mesh, in pixels; a coarser one takes fewer bytes",
         .listed = kOnGrid},
        {.name = "map-rounds",
         .group = map,
         .kind = count({1, kMaxMapRounds}, &B::map_rounds),
         .help = "Rounds that move pixels and fit colours to lower the error through the map",
         .listed = kInRounds},
        {.name = "map-rate",
         .group = map,
         .kind = number({0, 1e30}, &B::map_rate),  // far below the largest float, by which it is weighed
         .help = "What a bit of the pixel map costs against squared error; more takes fewer bytes",
         .listed = kRate},
        {.name = "bary",
         .group = map,
         .kind = words<std::optional<WeightPrecision>, WeightPrecision>(
             &B::bary, {{"half", WeightPrecision::kHalf}, {"float", WeightPrecision::kFloat}}),
         .help = "Precision of the pixel map",
         .otherwise = "half where the map stays one to one, else float"},
        {.name = "visits",
         .group = map,
         .kind = access<FlagParam>(&B::visits),
         .help = "Store how often the collapse touched each pixel",
         .listed = kVisits},

        {.name = "mesh-precision",
         .group = precision,
         .kind = words<MeshPrecision, MeshPrecision>(
             &B::mesh_precision, {{"exact", MeshPrecision::kExact}, {"compact", MeshPrecision::kCompact}}),
         .help = "Precision of the meshes; compact has half the bytes, and coarser positions and colours, "
                 "which cost at most a few hundredths of a dB",
         .listed = kCompact},
        {.name = "position-step",
         .group = precision,
         .kind = words<std::optional<double>, double>(
             &B::position_step,
             {{"1/32", 0.03125}, {"1/16", 0.0625}, {"1/8", 0.125}, {"1/4", 0.25}, {"1/2", 0.5}, {"1", 1}}),
         .help = "Grid of the vertices' positions, in pixels",
         .otherwise = "1/32; for compact 1/16 of the distance of vertices, at most 1/2",
         .listed = kWhereGiven},
        {.name = "color-levels",
         .group = precision,
         .kind = count({kLeastColorLevels, kMostColorLevels}, &B::color_levels),
         .help = "Number of levels of R, G and B of the vertices, equal steps of the sRGB curve",
         .otherwise = "65536 of linear RGB; for compact as few as add 1 % to the squared error",
         .listed = kWhereGiven},
    };
}

std::ostream& operator<<(std::ostream& out, const ChannelChoice& choice) {
    out << choice.name;
    return choice.weight == 1 ? out : out << ':' << choice.weight;
}

template <typename T>
std::string joined(const std::vector<T>& values) {
    std::ostringstream out;
    for (std::size_t k = 0; k < values.size(); ++k) out << (k ? "," : "") << values[k];
    return out.str();
}

// Returns a value as containers list it.
template <typename Kind>
BuildParameter::second_type listed_value(const Kind& kind, const typename Kind::Value& value) {
    if constexpr (std::is_same_v<Kind, WordParam>)
        return std::string(kind.words[value]);
    else if constexpr (requires { value.begin(); })
        return joined(value);
    else
        return value;
}

}  // namespace

const std::vector<Param>& param_table() {
    static const std::vector<Param> table = make_table();
    return table;
}

std::string value_text(const Param& param, const BuildParams& params) {
    return std::visit(
        [&](const auto& kind) -> std::string {
            const auto value = kind.get(params);
            if (!value) return "";
            return std::visit([](const auto& v) { return cat(v); }, listed_value(kind, *value));
        },
        param.kind);
}

std::string default_text(const Param& param) {
    if (std::holds_alternative<FlagParam>(param.kind)) return param.otherwise;
    const std::string text = value_text(param, BuildParams());
    return text.empty() ? param.otherwise : text;
}

void check_ranges(const BuildParams& params) {
    for (const Param& param : param_table())
        std::visit(
            [&](const auto& kind) {
                const auto value = kind.get(params);
                if constexpr (requires { kind.range; }) {
                    if (!value) return;
                    const auto check = [&](const auto& number, const std::string& name) {
                        if (!contains(kind.range, number))
                            throw Error(ErrorKind::kBadArgument,
                                        cat(name, " is ", number, ", expected ", describe(kind.range)));
                    };
                    if constexpr (requires { value->begin(); })
                        for (std::size_t k = 0; k < value->size(); ++k)
                            check((*value)[k], cat(param.name, " of level ", k));
                    else
                        check(*value, param.name);
                }
            },
            param.kind);
}

std::vector<BuildParameter> list_params(const BuildParams& params) {
    std::vector<BuildParameter> list;
    for (const Param& param : param_table())
        std::visit(
            [&](const auto& kind) {
                const auto value = kind.get(params);
                if (value && param.listed.holds(params))
                    list.emplace_back(param.name, listed_value(kind, *value));
            },
            param.kind);
    return list;
}

}  // namespace imgmesh
