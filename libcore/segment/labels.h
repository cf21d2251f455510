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

/// The region of every pixel, kNone outside the mask. Regions are 4-connected and numbered from 0 by their
/// first pixel, row by row.
struct LabelImage : Grid<Id> {
    std::size_t count = 0;  ///< of regions

    LabelImage() = default;
    LabelImage(Grid<Id> labels, std::size_t regions) : Grid(std::move(labels)), count(regions) {}
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
std::vector<RegionFacts> region_facts(const LabelImage& labels, const FeatureImage& image);

}  // namespace imgmesh
