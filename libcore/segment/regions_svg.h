// Regions as a drawing of shapes, for Inkscape, browsers and what reads SVG.
#pragma once

#include <string>
#include <vector>

#include "libcore/segment/region_outlines.h"

namespace imgmesh {

/// Returns an SVG document of the image's size with a path for each region, `region-0` and so on, which also
/// has its number as data-label. Neighbours share their points exactly; holes are holes. Each path has a
/// thin stroke of its own colour: without it, renderers leave hairline gaps between neighbours.
///
/// colors  one L*u*v* colour for each region, such as RegionFacts::color
std::string regions_svg(const RegionOutlines& outlines, const std::vector<Vec3f>& colors);

}  // namespace imgmesh
