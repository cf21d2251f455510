// Regions of tiles that become regions of the whole picture: the second pass over the tiles' seams.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "libcore/base/index.h"

namespace imgmesh {

/// What is known of a region of a tile.
struct TileRegion {
    Vec3f color = Vec3f::Zero();  ///< mean of all its pixels in the tile, L*u*v*
    std::int64_t pixels = 0;      ///< those that the tile owns: shared lines belong to one tile each
    /// The first of them, row by row: its place in the whole picture, row * width + column. Of no meaning
    /// without pixels.
    std::int64_t first = 0;
};

/// The regions of all tiles together.
struct JoinedRegions {
    /// Of every region of a tile, in the order of add(): its region of the whole picture. Those are numbered
    /// from 0 by their first pixel; kNone for regions none of whose pixels is owned.
    std::vector<Id> numbers;
    std::vector<std::int64_t> pixels;  ///< of each region of the whole picture
    std::int64_t across = 0;           ///< of these, consist of pieces of two tiles or more
};

/// Joins regions across the lines of pixels that two tiles share and both have segmented. Holds 28 bytes a
/// region, no pixels. The result does not depend on the order of the lines.
class RegionJoiner {
  public:
    /// threshold  of the segmentation inside the tiles [L*u*v*]
    explicit RegionJoiner(double threshold) : threshold_(threshold) {}

    /// Returns the number of the first of a tile's regions among those of all tiles; the others follow.
    Id add(std::span<const TileRegion> regions);

    /// Looks at a shared line. a, b: the region that each of its pixels has in either tile, by number among
    /// those of all tiles, kNone outside the mask. Two regions that have a pixel of the line in common become
    /// one
    /// - if their mean colours differ by at most the threshold, which is what merges two neighbours inside a
    ///   tile (exactly so with DistanceRule::kPaper; DistanceRule::kContour has the same unit); or
    /// - if more than half of the pixels that either has on the line are common. This is what a surface does
    ///   whose colour changes from tile to tile, such as a sky: both tiles have found its two ends on the
    ///   line. Half of one region's would be too little: a small region would join a large one that the
    ///   other tile has not cut there, and with it all others along the line.
    void add_line(std::span<const Id> a, std::span<const Id> b);

    JoinedRegions finish() const;

  private:
    double threshold_;
    std::vector<TileRegion> regions_;
    std::vector<std::pair<Id, Id>> pairs_;  // become one
};

}  // namespace imgmesh
