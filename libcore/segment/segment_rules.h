// What SegmentParams ask for, for pictures in one piece and in parts.
#pragma once

#include <string>
#include <string_view>

#include "libcore/segment/segment.h"

namespace imgmesh {

/// Throws Error(kBadArgument) for a parameter out of range.
void check_rules(const SegmentParams& params);

/// Throws Error(kBadArgument) for an image that has not the map's size, Error(kUnsupported) for one that is
/// not L*u*v*.
void check_picture(const Level& level, const FeatureImage& image);

/// Returns how many merges to do, by `segments`, `clearest` or `threshold`. `missed` and `source` are those
/// of merges_to_count().
std::size_t wanted_merges(const Hierarchy& hierarchy, const SegmentParams& params, std::string_view source,
                          std::string& missed);

}  // namespace imgmesh
