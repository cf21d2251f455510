// Builds a tile set: all of its jobs, or one.
#pragma once

#include "tools/build_options.h"
#include "tools/common/tool_main.h"

namespace imgmesh {

/// Does what the options of --tiles ask for and returns the report. The folder of -o may hold a set that was
/// begun: its finished tiles stay if they are of the same plan.
///
/// Tiles that cannot be read do not stop the others; each is a failure of `context`, so the exit code tells.
/// Throws Error as read_image_file() and build_mesh_image() do where nothing can be made.
Report build_tile_set(const BuildOptions& options, Context& context);

/// Prints the report of a set, or the plan.
void print_tile_set(const Report& report, std::ostream& out);

}  // namespace imgmesh
