// The edit that the command line of imgmesh-warp describes: --handle, --pin, --pin-border, --level, --solver.
#pragma once

#include <optional>

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

}  // namespace imgmesh
