// Sets of parameters that were measured together (docs/decisions/0013-defaults.md).
#pragma once

#include <string_view>
#include <vector>

#include "libcore/pipeline/build_params.h"

namespace imgmesh {

/// A set of parameters under a name.
struct Preset {
    std::string_view name;
    std::string_view help;  ///< what it is good for
    BuildParams params;
};

/// Returns all presets: fast, default (what BuildParams holds), best, max, small, fem.
const std::vector<Preset>& presets();

/// Returns the parameters of the preset of that name. Throws Error(kBadArgument) for an unknown name.
const BuildParams& preset_params(std::string_view name);

}  // namespace imgmesh
