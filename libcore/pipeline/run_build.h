// A build whose choices are made: of a whole image, or of a tile. Internal to the pipeline.
#pragma once

#include <vector>

#include "libcore/mesh/tile_sides.h"
#include "libcore/pipeline/build.h"
#include "libcore/simplify/simplify.h"

namespace imgmesh {

/// What shapes a build besides the image.
struct BuildPlan {
    BuildParams params;  ///< of params_in()
    FeatureSpace space;
    std::vector<SimplifyTarget> targets;  ///< finest level first
    SimplifyParams collapse;              ///< for the finest
    const TileSides* sides = nullptr;     ///< that stay as they are; none: sides are free
    FeatureImage* features = nullptr;     ///< where those of the pixels go at the end
};

/// Checks the image, and the mask, and returns an empty one if all pixels are inside. Throws as
/// build_mesh_image() does.
Mask checked_mask(const Image& image, Mask mask);

/// Returns the parameters with `refine` set. Throws Error(kUnsupported) for what is not possible in that
/// space.
BuildParams params_in(const FeatureSpace& space, BuildParams params);

/// Returns the parameters with errors in features instead of values' own unit.
BuildParams in_features(BuildParams params, double unit);

/// Returns how many pixels are inside the mask, or all.
std::int64_t meshed_pixels(const Image& image, const Mask& mask);

/// Runs a build. mask: of checked_mask(). own: the image itself, if its samples may be freed.
BuildResult run_build(const Image& image, Image* own, const BuildPlan& plan, const Progress& progress,
                      Mask mask);

}  // namespace imgmesh
