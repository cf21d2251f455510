// The pixel map of a base mesh, and the colours that go with it.
#pragma once

#include <optional>

#include "libcore/base/progress.h"
#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

struct FitParams {
    double color_weight = 1.0 / 30;  ///< of colour against smoothness (1 / mu of relax()); 0: the trivial map
    std::optional<WeightPrecision> bary;  ///< none: half where the map stays a bijection so, else float
    int rounds = 4;                       ///< of relaxation; colours are refitted after each
    int sweeps = 4;                       ///< of relaxation in each round
    FeatureSpace space;                   ///< of the image
    bool keep_colors = false;             ///< the mesh's features stay, except for rounding
    double gouraud_share =
        0.1;  ///< how much the drawing without the map counts in the fit of colours, 0 to 1
};

/// Finds the pixel map (relax.h, quantize_map.h) and replaces the mesh's features by the least-squares ones
/// (unless params.keep_colors), with colours rounded to what a container holds. The map is a bijection of the
/// pixel grid onto the mesh.
///
/// mesh     covers the image's rectangle, or every pixel inside the mask; positions on kPositionStep
/// mask     empty(), or of the image's size: pixels outside get no face
/// feature  the image, params.space.features() channels
/// Throws Error(kUnsupported) if params.bary is too coarse for the mesh's faces.
PixelMap fit_map(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params,
                 const Progress& progress = {}, const Mask& mask = {});

/// The same for an existing map, made by a tracker. Its weights are rounded to the grid, its folds stay.
/// Halves are used unless their step would be an eighth of a pixel in some face.
PixelMap fit_given_map(BaseMesh& mesh, const FeatureImage& feature, PixelMap map, const FitParams& params,
                       const Mask& mask = {});

}  // namespace imgmesh
