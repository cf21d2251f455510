// The parameters of a build. docs/parameters.md lists each with its name, its range and what it does.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "libcore/image/feature_space.h"
#include "libcore/mesh/displacements.h"
#include "libcore/mesh/pixel_map.h"
#include "libcore/param/fit_map.h"
#include "libcore/refine/refine_params.h"
#include "libcore/simplify/simplify_params.h"

namespace imgmesh {

/// When the collapse stops. The first limit reached counts; if none is given, `density` counts.
struct StopParams {
    std::optional<std::int64_t> faces;     ///< at most this many faces; >= 2
    std::optional<std::int64_t> vertices;  ///< at most this many vertices; >= 4
    std::optional<double>
        error;  ///< no collapse above this total quadric error (paper sec. 3.1) [L*u*v*^2 px^2]
    /// instead: as few vertices (to about 3 %) as an RMS of at most this through the pixel map takes; 0 or
    /// more [L*u*v*]. One level only. The dense mesh if even that has a larger RMS.
    std::optional<double> rms;
    double density = 1.0;  ///< percent of the pixels that stay vertices; in (0, 100]
};

inline constexpr int kMaxLevels = 32;
inline constexpr int kMaxSmoothing = 64;

/// The pyramid: nested base meshes of one run, each with a pixel map of its own.
struct PyramidParams {
    int count = 1;  ///< levels, each with a quarter of the faces of the one before; 1 to 32
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

/// The error of the mesh drawn alone that refinement lowers.
enum class Objective {
    kLuv,  ///< L*u*v*; colours are then fitted to the pixel map and to the drawing
    kRgb   ///< encoded sRGB, interpolated as such; colours are the best for that drawing alone
};

/// How finely the meshes' positions and colours are stored.
enum class MeshPrecision {
    kExact,   ///< positions on kPositionStep, colours as 16-bit codes of linear RGB
    kCompact  ///< half the bytes, for at most a few hundredths of a dB (docs/decisions/0035-lean-meshes.md)
};

inline constexpr int kMaxRefine = 1000;
inline constexpr int kMaxAnneal = 100000;
inline constexpr int kMaxMapRounds = 1000;

/// All of it. Defaults are those of the preset "default".
struct BuildParams {
    std::vector<ChannelChoice> channels;  ///< the feature space; none: the image's colour
    /// Channels are values, not colours: none becomes L*u*v* or is clipped, `channels` are by default all but
    /// A, and errors (in StopParams, PyramidParams and reports) are in the values' unit.
    bool values = false;
    StopParams stop;  ///< of the finest level
    PyramidParams levels;
    Metric metric = SimplifyParams().metric;
    Solver solver = SimplifyParams().solver;
    /// lambda: geometry against colour in the quadrics [L*u*v*^2 / px^2]; > 0
    double geometry_weight = kUsualGeometryWeight;
    double color_weight = 1.0;  ///< of colour in the quadrics; only the ratio counts, 1e-9 to 1e9
    /// rebuild quadrics from the mesh at every halving ("memoryless")
    bool rebuild_quadrics = SimplifyParams().rebuild_quadrics;
    /// edges are ordered by total error, as in the paper, not by what a merge adds; none: only for metrics
    /// other than the flattened one
    std::optional<bool> total_priority;
    /// passes of [1 2 1] / 4 before gradients are taken; none: by density for the flattened metric, else 0
    std::optional<int> smoothing;
    bool quadric_colors = false;  ///< vertex colours are those of the quadrics, as in the paper, not fitted
    std::optional<MapKind> map;   ///< none: relaxed, or trivial if projection_color_weight is 0
    /// relaxed: of colour against smoothness; tracked: of squared L*u*v* against squared pixels in the
    /// flattened rings. 0 is the trivial map and excludes the two others, which need more; none: what
    /// FitParams or TrackParams have.
    std::optional<double> projection_color_weight;
    int map_steps = kUsualSteps;  ///< of the grid of a relaxed or trivial map in a pixel: 8, 16 or 32
    std::int64_t map_rounds = FitParams().rounds;  ///< relaxed; 1 to kMaxMapRounds
    double map_rate = 0;  ///< relaxed: what a bit of a displacement costs [feature^2]; >= 0
    bool visits = false;  ///< count how often the collapse down to the finest level touches each pixel
    std::optional<WeightPrecision> bary;      ///< none: half where the map stays a bijection, else float
    std::optional<std::int64_t> max_cluster;  ///< no face with more pixels than this; >= 3
    /// Rounds of refinement of each level; 0 to kMaxRefine. None: those of RefineParams if the features are
    /// a colour and the metric is the flattened one with fitted colours, else 0. A tracked map allows only
    /// 0.
    std::optional<std::int64_t> refine;
    double shape_weight = RefineParams().shape_weight;
    double exchange = RefineParams().exchange;
    std::int64_t anneal = RefineParams().anneal;  ///< only with exchange; 0 to kMaxAnneal
    Objective objective = Objective::kLuv;
    double min_quality = RefineParams().min_quality;  ///< of every triangle, collapsed or refined; 0 to 0.8
    MeshPrecision mesh_precision = MeshPrecision::kExact;
    /// Vertex positions are multiples of this where no face turns over by that; a power of two from
    /// kPositionStep to 1 [pixels]. None: by mesh_precision. A tracked map allows only kPositionStep.
    std::optional<double> position_step;
    /// Equal steps of the sRGB curve that each of R, G and B has (ColorLevels). None: by mesh_precision. Only
    /// for colours without HDR.
    std::optional<std::int64_t> color_levels;
    /// The levels' maps are only to say which pixels are inside, for meshes that are written without: `map`
    /// is kTrivial, maps keep weights that are not rounded, and colours are fitted to the drawing without a
    /// map.
    bool map_is_left_out = false;
};

/// Return the map and the colour weight that a build uses for `params`, defaults filled in.
MapKind map_kind(const BuildParams& params);
double map_color_weight(const BuildParams& params);

}  // namespace imgmesh
