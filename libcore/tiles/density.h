// The threshold at which a whole set of tiles has the wanted density: found on samples of the picture,
// because each tile is then built by itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/pipeline/build_tile.h"
#include "libcore/simplify/simplify_params.h"
#include "libcore/tiles/tile_grid.h"

namespace imgmesh {

/// Returns the parameters of the collapse of each tile of a set, as build_tile() has them.
SimplifyParams tile_collapse(const BuildParams& params, const TileCommon& common);

/// How many vertices parts of the picture keep at each of sample_thresholds(), collapsed by themselves.
struct DensitySample {
    double pixels = 0;             ///< where vertices are counted, inside the mask
    double border = 0;             ///< length of the parts' sides [steps]
    std::vector<double> counted;   ///< vertices; those on a side of a part count half
    std::vector<double> on_sides;  ///< vertices that the collapse leaves on sides of the parts
    std::vector<double> decided;   ///< vertices that the sides would have as those of tiles

    /// Adds another one's parts.
    void add(const DensitySample& other);
};

/// The thresholds of samples, rising: powers of the square root of two [feature^2 px^2].
std::span<const double> sample_thresholds();

/// A part of the picture that is collapsed as a sample.
struct SampledPart {
    PixelRect pixels;
    /// Pixels between those of this margin count. What is nearer to a side has another density than in the
    /// midst of a tile, as the side is a border of the sample's mesh.
    int margin = 0;
};

/// Collapses a part of the picture, with free sides, and counts.
///
/// part     its pixels
/// margin   see SampledPart; less than half of the part's sides
/// params   of the collapse, as for the tiles
/// density  that is wanted [vertices in 100 pixels]
DensitySample sample_density(FeatureImage part, Mask mask, int margin, const SimplifyParams& params,
                             double density);

/// Returns the parts of a row of tiles that are sampled: all of them, whole, while the picture has at most
/// kSampledWhole pixels. Of larger ones windows that are spread evenly, an eighth of the pixels, at least
/// about so many. A window is sixteen times as wide as vertices are apart on average.
///
/// density  that is wanted [vertices in 100 pixels]
inline constexpr std::int64_t kSampledWhole = std::int64_t{1} << 25;
std::vector<SampledPart> sampled_parts(const TileGrid& grid, int row, double density);

/// Returns the threshold at which a picture of that size has `vertices` vertices, by interpolation between
/// those of the samples.
double threshold_for(const DensitySample& samples, const TileGrid& grid, double vertices);

}  // namespace imgmesh
