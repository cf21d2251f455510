// The whole pipeline on one screen: from an image to a pyramid of base meshes with pixel maps. Read this
// first.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/mesh_image.h"
#include "libcore/pipeline/build_params.h"

namespace imgmesh {

/// Figures of a level, measured on what a reader of the container gets.
struct LevelReport {
    /// through the pixel map [L*u*v*, or features with their weights; of values in their unit]
    double map_rms = 0;
    double gouraud_rms = 0;             ///< of the base mesh drawn without the map, in the same unit
    std::vector<double> auxiliary_rms;  ///< of each auxiliary channel, through the map [its own unit]
    double position_step = 0;           ///< of the vertices [pixels]
    std::size_t fine_vertices = 0;      ///< that are no multiples of it, only of kPositionStep
    int color_levels = 0;               ///< ColorLevels of the colours; 0 where they are not rounded to any
    std::size_t target = 0;             ///< which of the wanted levels this is; the missing ones are alike
};

/// Wall time of the stages, all levels together [s].
struct BuildSeconds {
    double collapse = 0;  ///< includes L*u*v* and the dense mesh
    double refine = 0;
    double map = 0;  ///< includes the fit of colours and the figures of LevelReport
};

struct BuildReport {
    BuildSeconds seconds;
    std::int64_t pixels = 0;           ///< meshed pixels: those inside the mask, or all
    std::int64_t clipped_samples = 0;  ///< of those pixels' colour: no container holds them
    std::int64_t collapses = 0;
    std::int64_t rejected = 0;  ///< collapses that the tracked map has rejected
    std::vector<LevelReport> levels;
};

struct BuildResult {
    MeshImage mesh_image;  ///< without generator; `parameters` lists every parameter that shaped the result
    BuildReport report;
};

/// Builds a MeshImage: image -> features -> dense mesh of all pixels -> collapse -> base mesh -> refinement
/// -> pixel map -> least-squares features. Source: the paper, sec. 3; docs/paper-map.md lists what differs.
///
/// image     at least one pixel. Alpha counts only as a channel of params.channels. Linear RGB below 0 is
///           clipped to 0, and above 1 to 1 unless the image is HDR (gamut_of). A side of one pixel counts
///           as a strip one pixel wide (docs/format.md).
/// progress  called now and then, on this thread
/// mask      the pixels to mesh, of the image's size; empty() for all. Exactly the others have no face in
///           the map. Percents and shares are of the pixels inside.
/// return    levels, finest first, each once: a wanted level with the same mesh as the one before is left
/// out.
///           missed_targets() (targets.h) tells what was not reached. A container keeps positions, colours
///           and weights exactly
///
/// The result is the same for any number of threads. With default parameters takes about 2 us of processor
/// time for each pixel, and 85 bytes of memory beside the image (docs/performance.md).
/// Throws Error(kBadArgument) for a parameter out of range, Error(kBadFile) for a mask of another size, and
/// Error(kUnsupported) for a mask without a pixel inside and for an image without colour channels or with
/// values that are not finite; also as feature_space() and extract_features() do.
BuildResult build_mesh_image(const Image& image, const BuildParams& params, const Progress& progress = {},
                             Mask mask = {});
/// The same, but the image's samples are freed as soon as they have become features.
BuildResult build_mesh_image(Image&& image, const BuildParams& params, const Progress& progress = {},
                             Mask mask = {});

}  // namespace imgmesh
