// The whole pipeline on one screen: an image in, a pyramid of base meshes with pixel maps out. Read this
// first.
#pragma once

#include <optional>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/simplify/metric.h"

namespace imgmesh {

/// When the collapse stops. The first limit reached counts; with none given, `density` does.
struct StopParams {
    std::optional<std::int64_t> faces;     ///< at most this many faces; >= 2
    std::optional<std::int64_t> vertices;  ///< at most this many vertices; >= 4
    std::optional<double>
        error;  ///< no collapse above this total quadric error (paper sec. 3.1) [L*u*v*^2 px^2]
    /// instead: as few vertices as an RMS of at most this through the pixel map takes, to about 3 %; 0 or
    /// more [L*u*v*]. One level only. Error(kUnsupported) where the dense mesh has a larger one.
    std::optional<double> rms;
    double density = 1.0;  ///< percent of the pixels that stay vertices; in (0, 100]
};

inline constexpr int kMaxLevels = 32;
inline constexpr int kMaxSmoothing = 64;

/// The pyramid: nested base meshes of one run, each with a pixel map of its own.
struct PyramidParams {
    int count = 1;  ///< levels, each but the finest with a quarter of the faces of the one before; 1 to 32
    std::vector<std::int64_t>
        faces;  ///< instead: faces of each level, falling, >= 2; then StopParams do not count
    std::vector<double>
        errors;  ///< instead: quadric error of each level, rising; then StopParams do not count
};

/// How pixels find their places on the base mesh.
enum class MapKind {
    kRelaxed,  ///< moved to where the mesh has their colours, without a fold
    kTracked,  ///< carried through every collapse (paper sec. 3.3); it may fold
    kTrivial   ///< each at its own place
};

/// Which error refinement lowers, of the mesh drawn alone.
enum class Objective {
    kLuv,  ///< L*u*v*; colours are then fitted to the pixel map and to the drawing
    kRgb   ///< encoded sRGB, interpolated as such; colours are what that drawing alone wants
};

inline constexpr int kMaxRefine = 1000;
inline constexpr int kUsualRefine = 2;
inline constexpr double kUsualMapColorWeight = 1.0 / 20;  ///< of the relaxed map

struct BuildParams {
    std::vector<ChannelChoice> channels;  ///< the feature space; none: the image's colour
    StopParams stop;                      ///< of the finest level
    PyramidParams levels;
    Metric metric = Metric::kFlattened;
    Solver solver = Solver::kClosed;
    double geometry_weight = 0.3;  ///< lambda: geometry against colour in the quadrics [L*u*v*^2 / px^2]; > 0
    double color_weight = 1.0;     ///< of colour in the quadrics; only the ratio counts, 1e-9 to 1e9
    bool rebuild_quadrics = false;  ///< take quadrics anew from the mesh at every halving ("memoryless")
    /// edges go by total error, as in the paper, not by what a merge adds; none: for metrics but the
    /// flattened
    std::optional<bool> total_priority;
    /// passes of [1 2 1] / 4 before gradients are taken; none: by density for the flattened metric, else 0
    std::optional<int> smoothing;
    bool quadric_colors = false;  ///< vertex colours are those of the quadrics, as in the paper, not fitted
    std::optional<MapKind> map;   ///< none: relaxed, or trivial where projection_color_weight is 0
    /// relaxed: of colour against smoothness; tracked: of squared L*u*v* against squared pixels in the
    /// flattened rings. 0 is the trivial map and excludes the two others, which need more; none: the map's
    /// default (map_color_weight).
    std::optional<double> projection_color_weight;
    bool visits = false;  ///< count how often the collapse down to the finest level touches each pixel
    std::optional<WeightPrecision> bary;      ///< none: half where the map stays a bijection, else float
    std::optional<std::int64_t> max_cluster;  ///< no face with more pixels than this; >= 3
    /// Rounds of refinement of each level; 0 to kMaxRefine. None: kUsualRefine where the
    /// features are a colour and the metric the flattened one with fitted colours, else 0; 0 for a
    /// tracked map, which takes none.
    std::optional<std::int64_t> refine;
    double shape_weight = 0.22;  ///< of the triangles' shape in refinement; >= 0
    double exchange = 0;         ///< share of vertices that a round adds and takes away elsewhere; 0 to 1
    Objective objective = Objective::kLuv;
    double min_quality = 0;  ///< no triangle of a lesser q = 4 sqrt(3) area / sum of squared edges; 0 to 0.8
};

/// Figures of a level, measured on what a reader gets back.
struct LevelReport {
    double map_rms = 0;                 ///< through the pixel map [L*u*v*, or features with their weights]
    double gouraud_rms = 0;             ///< base mesh drawn without the map, likewise
    std::vector<double> auxiliary_rms;  ///< of each channel beside the colour, through the map [its own unit]
};

/// Wall time of the stages, all levels together [s].
struct BuildSeconds {
    double collapse = 0;  ///< with L*u*v* and the dense mesh
    double refine = 0;
    double map = 0;  ///< with the fit of colours, and the figures of LevelReport
};

struct BuildReport {
    BuildSeconds seconds;
    std::int64_t pixels = 0;  ///< meshed: those inside the mask, or all
    std::int64_t collapses = 0;
    std::int64_t rejected = 0;  ///< collapses that the tracked map has forbidden
    std::vector<LevelReport> levels;
};

/// What BuildParams::map and projection_color_weight come to.
MapKind map_kind(const BuildParams& params);
double map_color_weight(const BuildParams& params);

struct BuildResult {
    MeshImage mesh_image;  ///< without generator; `parameters` lists every parameter that shaped the result
    BuildReport report;
};

/// Builds a MeshImage: image -> features -> dense mesh of all pixels -> collapse -> base mesh -> refinement
/// -> pixel map -> least-squares features. Source: the paper, sec. 3; docs/paper-map.md lists what differs.
///
/// image     at least one pixel. Alpha counts only as a channel of params.channels. Linear light below 0 is
///           clipped to 0, and above 1 to 1 unless the image is one of floats (gamut_of). A side of one
///           pixel counts as a strip one pixel wide (docs/format.md).
/// progress  called now and then, on this thread
/// mask      the pixels to mesh, of the image's size; empty() for all. Exactly the others have no face in
///           the map. Percents and shares are of the pixels inside.
/// return    levels, finest first; a container keeps their positions, colours and weights exactly
///
/// The result is the same for any number of threads. With default parameters takes about 2 us of processor
/// time and 110 bytes of memory for each pixel (docs/performance.md).
/// Throws Error(kBadArgument) for a parameter out of range, Error(kBadFile) for a mask of another size, and
/// Error(kUnsupported) for a mask without a pixel inside and for an image without colour channels or with
/// values that are not finite; also as feature_space() and extract_features() do.
BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress = {},
                             Mask mask = {});

}  // namespace imgmesh
