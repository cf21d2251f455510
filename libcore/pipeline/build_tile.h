// The build of one tile of a picture of any size: what lies on its sides is given, and its neighbours have
// the same.
#pragma once

#include <optional>
#include <span>

#include "libcore/mesh/tile_sides.h"
#include "libcore/pipeline/build.h"

namespace imgmesh {

/// What all tiles of a set share.
struct TileCommon {
    FeatureSpace space;                           ///< of tile_space()
    SampleType sample_type = SampleType::kUint8;  ///< of the picture
    /// No collapse adds more than this. None: StopParams::error bounds the total error of each collapse.
    /// [feature units^2 px^2]
    std::optional<double> max_increment;
    double density = 1;  ///< vertices of the set, in percent of its pixels
};

/// Throws Error(kBadArgument) as check_params() does, and Error(kUnsupported) for what tiles do not have: a
/// tracked map, a pyramid of their own, an RMS to reach, and values, whose unit depends on the whole picture.
void check_tile_params(const BuildParams& params);

/// Returns the feature space of a set of tiles whose colours have that gamut. `part` has the picture's
/// channels. Throws as feature_space() does.
FeatureSpace tile_space(const Image& part, const BuildParams& params, Gamut gamut);

/// Returns the features of a tile, or of a line of pixels, exactly as the build of any tile sees them.
FeatureImage tile_features(const Image& part, const TileCommon& common, const Mask& mask = {});

/// Rounds vertices' features, interleaved, to what a container of a tile holds of them.
void round_tile_features(std::span<float> features, const BuildParams& params, const TileCommon& common);

/// Builds the mesh image of one tile, of one level, as build_mesh_image() does. Vertices on the sides of its
/// rectangle are those of `sides`, in their places and with their features; pixels there lie where the sides
/// have them. All else depends on `image` and on what all tiles share.
///
/// image   both sides at least 2; its samples are freed
/// params  of check_tile_params(). StopParams count only as said at TileCommon. What the density or the error
///         of an image decides in build_mesh_image() is decided for the set: smoothing, the step of
///         positions, and kCompactLevels levels of colours. Weights are floats unless params.bary says more,
///         so that both tiles put a pixel of their line at the same place.
///         min_quality does not hold at sides: what has to go there goes, whatever triangles that leaves
/// sides   features as round_tile_features() leaves them. Pixels beside a corner are shifted by less than a
///         pixel, or at least the product of the two there is below 1: then no cell folds. Up to 3/4 they
///         keep the area that moving pixels keep (least_moving_area)
/// mask    the pixels to mesh. Where it cuts a side, all pixels inside are vertices
/// features  if not null: gets tile_features() of the image, which the build has anyway
///
/// Throws as build_mesh_image() and check_tile_params() do, and Error(kBadArgument) for sides of other
/// lengths.
BuildResult build_tile(Image&& image, const BuildParams& params, const TileSides& sides,
                       const TileCommon& common, const Progress& progress = {}, Mask mask = {},
                       FeatureImage* features = nullptr);

}  // namespace imgmesh
