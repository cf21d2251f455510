// The error of a tile, in sums that add up to that of the whole set.
#pragma once

#include <cstdint>

#include "libcore/image/image.h"
#include "libcore/image/mask.h"
#include "libcore/mesh/mesh_image.h"

namespace imgmesh {

/// Sums over pixels [features^2].
struct TileErrors {
    std::int64_t pixels = 0, seam_pixels = 0;
    double squares = 0;       ///< of all pixels that the tile owns
    double seam_squares = 0;  ///< of those of them that lie on lines that tiles share, and beside them
};

/// Pixels that are at most so far from a shared line count as its seam.
inline constexpr int kSeamReach = 2;

/// Which sides of a tile another one shares.
struct TileSeams {
    bool left = false, top = false, right = false, bottom = false;
};

/// Returns the squared errors of the pixels that a tile owns, through its map.
///
/// level    the tile's mesh and map, with the features of `feature`
/// feature  of all pixels of the tile
/// own      those that count as its own, of the tile's size
TileErrors tile_errors(const Level& level, const FeatureImage& feature, const Mask& own,
                       const TileSeams& seams);

}  // namespace imgmesh
