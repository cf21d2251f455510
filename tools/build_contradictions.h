// Conflicting options of imgmesh-build are reported as the user typed them.
#pragma once

#include "libcore/pipeline/build_params.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// Throws Error(kBadArgument), one line with the options as given and the reason, if `params`, which come
/// from the parsed options of `app`, exclude each other or are out of range together.
void check_contradictions(const CLI::App& app, const BuildParams& params);

/// The same for options that need the pixel map which --no-map leaves out.
void check_no_map(const CLI::App& app, const BuildParams& params);

/// Returns parameters that give the same base meshes without the work on a relaxed map. A tracked map stays,
/// as it decides which edges collapse.
BuildParams without_map(BuildParams params);

}  // namespace imgmesh
