// imgmesh-convert on tile sets.
#pragma once

#include "tools/common/tool_main.h"
#include "tools/convert_options.h"

namespace imgmesh {

/// Throws Error(kBadArgument) for options that mean nothing for a tile set or for its output, and
/// Error(kUnsupported) for outputs that it has not.
void check_set_options(const ConvertOptions& options);

/// Writes all tiles of a level as one mesh: a .glb or .gltf without a pixel map, .ply, .obj or .svg. One unit
/// is a pixel of the level. Returns the report's members.
Report convert_set(const ConvertOptions& options, Context& context);

}  // namespace imgmesh
