// The pixel map of a base mesh, and the colours that go with it.
#pragma once

#include <optional>

#include "libcore/base/progress.h"
#include "libcore/image/feature_space.h"
#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/base_mesh.h"
#include "libcore/mesh/displacements.h"
#include "libcore/mesh/pixel_map.h"

namespace imgmesh {

struct TileSides;

struct FitParams {
    double color_weight = 1.0 / 20;  ///< of colour against smoothness [px^2 / feature^2]; 0: the trivial map
    std::optional<WeightPrecision> bary;  ///< none: half where the map stays a bijection with it, else float
    int steps = kUsualSteps;              ///< of the grid of positions in a pixel: 8, 16 or 32
    double rate = 0;           ///< cost of a bit of a displacement [feature^2], for a shorter stream; >= 0
    int rounds = 3;            ///< of relaxation, colours refitted after each
    int sweeps = 2;            ///< of relaxation a round; the first round, and with a rate each, has one more
    FeatureSpace space;        ///< of the image
    bool keep_colors = false;  ///< keep the mesh's features, but for rounding
    double gouraud_share = 0.1;  ///< weight of the drawing without the map in the fit of colours, 0 to 1
    /// Of a tile: vertices on its image's sides keep their features, and pixels there lie where these have
    /// them. None: the image is no tile.
    const TileSides* sides = nullptr;
};

/// Finds the pixel map of any base mesh over an image: every pixel moves a little to where the mesh has its
/// colour, while the grid of pixels stays a grid without a fold. The map is a bijection, rounded to what a
/// container holds. Unless params.keep_colors, the mesh's features become the least-squares ones for that
/// map, colours rounded likewise. Same result for any number of threads. Takes O(pixels) time in each sweep.
///
/// mesh     covers the image's rectangle, or every pixel inside the mask; positions on kPositionStep
/// mask     empty(), or of the image's size: pixels outside get no face
/// feature  the image, params.space.features() channels
/// Throws Error(kUnsupported) if params.bary is too coarse for the mesh's faces.
PixelMap fit_map(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params,
                 const Progress& progress = {}, const Mask& mask = {});

/// Returns the trivial map with weights that are not rounded, for a mesh that is stored without one, and fits
/// features to the drawing of the mesh, as fit_map() does.
PixelMap fit_drawing(BaseMesh& mesh, const FeatureImage& feature, const FitParams& params,
                     const Mask& mask = {});

/// The same as fit_map() for a map that is there already: its weights are rounded to the grid, and folds
/// stay. Without a choice the grid is that of halves, unless a face is so large that a step would be an
/// eighth of a pixel.
PixelMap fit_given_map(BaseMesh& mesh, const FeatureImage& feature, PixelMap map, const FitParams& params,
                       const Mask& mask = {});

}  // namespace imgmesh
