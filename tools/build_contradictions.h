// Options of imgmesh-build that are right alone and contradict each other, told in the words that were typed.
#pragma once

#include "libcore/pipeline/build_params.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// Throws Error(kBadArgument), in one line with the options as given and the reason, where `params`, which
/// come from the parsed options of `app`, exclude each other or are outside their range together.
void check_contradictions(const CLI::App& app, const BuildParams& params);

}  // namespace imgmesh
