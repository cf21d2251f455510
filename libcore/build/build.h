// The whole pipeline on one screen: a picture in, a pyramid of base meshes with pixel maps out. Read this
// first.
#pragma once

#include <optional>

#include "libcore/base/progress.h"
#include "libcore/image/image.h"
#include "libcore/param/mesh_image.h"

namespace imgmesh {

/// When the collapse stops. The first limit reached counts; with none given, `density` does.
struct StopParams {
    std::optional<std::int64_t> faces;     ///< at most this many faces; >= 2
    std::optional<std::int64_t> vertices;  ///< at most this many vertices; >= 4
    std::optional<double>
        error;             ///< no collapse above this total quadric error (paper sec. 3.1) [L*u*v*^2 px^2]
    double density = 1.0;  ///< percent of the pixels that stay vertices; in (0, 100]
};

struct BuildParams {
    StopParams stop;
    double geometry_weight = 3.0;  ///< lambda: geometry against colour in the quadrics [L*u*v*^2 / px^2]; > 0
    double color_weight = 1.0;     ///< of colour in the quadrics; only the ratio of the two weights matters
    double projection_color_weight =
        1.0 / 30;                         ///< of colour against smoothness in the pixel map; 0: trivial map
    std::optional<WeightPrecision> bary;  ///< none: half where the map stays a bijection so, else float
};

/// Figures of a build, all measured on the finished levels as a reader gets them back.
struct BuildReport {
    std::int64_t collapses = 0;
    double map_rms = 0;      ///< of level 0, through the pixel map [L*u*v*]
    double gouraud_rms = 0;  ///< of level 0, base mesh drawn without the map [L*u*v*]
};

struct BuildResult {
    MeshImage mesh_image;  ///< without generator; `parameters` lists every parameter that shaped the result
    BuildReport report;
};

/// picture -> L*u*v* -> dense mesh -> collapse -> base mesh -> pixel map -> least-squares colours.
/// A side of one pixel counts as a strip one pixel wide (docs/format.md). Alpha is ignored.
/// Same result for any number of threads. Throws Error(kUsage) for a parameter out of range,
/// Error(kUnsupported) for a picture without colour channels or with values that are not finite.
BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress = {});

}  // namespace imgmesh
