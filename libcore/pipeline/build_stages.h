// The stages of a build behind the dense mesh. Internal to the pipeline.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "libcore/base/progress.h"
#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/grid_mesh.h"
#include "libcore/mesh/tile_sides.h"
#include "libcore/pipeline/build.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// Maps the progress of a part to [begin, end] of the whole.
Progress part_of(const Progress& whole, double begin, double end);

/// Turns collapsed meshes into levels.
struct BuildStages {
    const FeatureImage& feature;
    const GridMesh& grid;
    const FeatureSpace& space;
    const Mask& mask;
    const BuildParams& params;
    BuildReport& report;
    const Progress& progress;
    const TileSides* sides;  ///< that stay as they are; none: sides are free

    std::vector<SimplifyResult> collapse(const SimplifyParams& limits,
                                         std::span<const SimplifyTarget> targets,
                                         const SimplifyHooks& hooks = {}) const;
    /// Refines, makes the pixel map (unless `tracked` has one) and fits colours. Takes the share [begin, end]
    /// of the progress.
    Level finish(SimplifyResult&& collapsed, const SimplifyParams& limits, std::optional<PixelMap> tracked,
                 LevelReport& figures, double begin, double end) const;
    /// Gives the vertices on sides that stay their features again: other colour spaces and weights are not
    /// exact.
    void set_sides(BaseMesh& mesh) const;
    /// Estimates the error of the map of an unrefined mesh after one round.
    double estimated_rms(SimplifyResult&& collapsed) const;
};

/// Collapses and makes maps with the present limits of the collapse.
void build_levels(const BuildStages& stages, const SimplifyParams& limits,
                  std::span<const SimplifyTarget> targets, MeshImage& mesh_image);

}  // namespace imgmesh
