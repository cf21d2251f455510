// imgmesh-segment on tile sets.
#pragma once

#include "tools/common/tool_main.h"
#include "tools/segment_options.h"

namespace imgmesh {

/// Segments a level of a set as if it were one picture (segment_parts.h), and writes one picture of labels. A
/// TIFF is written row of tiles by row of tiles; any other format is held whole. Returns the report's
/// members. Throws Error(kBadArgument) for options that need the whole picture at once.
Report segment_set(const SegmentOptions& options, Context& context);

}  // namespace imgmesh
