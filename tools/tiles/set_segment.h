// imgmesh-segment on tile sets.
#pragma once

#include "tools/common/tool_main.h"
#include "tools/segment_options.h"

namespace imgmesh {

/// Segments a level of a set tile by tile, joins the regions across the tiles' seams (join_regions.h), and
/// writes one picture of labels. A TIFF is written row of tiles by row of tiles; any other format is held
/// whole. Returns the report's members. Throws Error(kUnsupported) for options that are about the whole
/// picture.
Report segment_set(const SegmentOptions& options, Context& context);

}  // namespace imgmesh
