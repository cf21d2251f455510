// The edit that the command line of imgmesh-warp describes: --handle, --pin, --pin-border, --level, --solver.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "libcore/mesh/mesh_image.h"
#include "libcore/warp/warp_edits.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// One edit, of all handles and pins that were given; none without a handle.
struct HandleOptions {
    WarpEdit edit;                     ///< without the solver
    std::optional<WarpSolver> solver;  ///< none: arap if there are pins, else direct
};

/// Adds the options. Those of pins, level and solver are refused without a handle.
void add_handle_options(CLI::App& app, HandleOptions& options);

/// Returns the edit; none if no handle was given.
std::optional<WarpEdit> handle_edit(const HandleOptions& options);

/// Returns a line for each point of handles and pins that is far outside the image.
std::vector<std::string> far_points(const WarpEdits& edits, const SourceInfo& source);

}  // namespace imgmesh
