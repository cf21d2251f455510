// The first pass over a picture in parts: each is merged to some hundred regions, which make one graph.
#pragma once

#include <cstdint>
#include <vector>

#include "libcore/segment/contours/small_image.h"
#include "libcore/segment/region_graph.h"
#include "libcore/segment/segment_parts.h"

namespace imgmesh {

/// Regions of all parts.
struct FirstRegions {
    PartLabels labels;      ///< numbered by their first pixel in the picture
    RegionGraph graph;      ///< borders go over the sides of parts; places are those in the parts
    std::size_t cells = 0;  ///< that they are made of
};

/// Returns to how many regions a part is merged that has so many of the picture's pixels: its share of
/// 150,000, or of 4 times the number that is wanted if that is more; at least one for 4096 pixels, up to 64.
std::size_t fine_regions(double part, double picture, const SegmentParams& params);

/// Cuts and merges all parts, by the squares' contrasts or, for kPaper, by mean colours. Adds their pixels to
/// `small` if it is given.
FirstRegions first_regions(const PictureParts& picture, const SegmentParams& params, SmallImageSums* small,
                           const Progress& progress);

/// Returns the rank of each number: 0 for the least. No two are equal.
std::vector<Id> ranks(const std::vector<std::int64_t>& numbers);

/// Returns, for each of `count` regions, the place of its first pixel in the picture: row * width + column.
std::vector<std::int64_t> first_pixels(const Grid<Id>& labels, std::size_t count, const PixelRect& rect,
                                       int picture_width);

}  // namespace imgmesh
