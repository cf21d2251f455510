// An image cut into regions, and facts about each of them.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "libcore/image/image.h"
#include "libcore/segment/cells.h"
#include "libcore/segment/hierarchy.h"

namespace imgmesh {

/// The region of every pixel. Regions are 4-connected and numbered from 0 by their first pixel, row by row.
struct LabelImage {
    int width = 0;
    int height = 0;
    std::size_t count = 0;
    std::vector<Id> labels;  ///< size width * height; kNone outside the mask

    Id at(int x, int y) const {
        return labels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Returns the regions after the first `merges` merges of the cells' hierarchy. Takes O(pixels) time.
LabelImage labels_after(const Cells& cells, const Hierarchy& hierarchy, std::size_t merges);

/// What is known about one region.
struct RegionFacts {
    std::int64_t pixels = 0;
    Vec3f color = Vec3f::Zero();                         ///< mean, L*u*v*
    std::array<int, 4> box = {0, 0, 0, 0};               ///< smallest x, smallest y, largest x, largest y
    std::vector<std::pair<Id, std::int64_t>> neighbors;  ///< sorted: region, pixel pairs across
};

/// Returns the facts of every region, by its number. The image is L*u*v*, of the labels' size. Takes
/// O(pixels) time.
std::vector<RegionFacts> region_facts(const LabelImage& labels, const FeatureImage& picture);

}  // namespace imgmesh
