// Options for the limits that a reader checks before it takes memory.
#pragma once

#include "formats/container/container.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// --max-bytes, --max-pixels, --max-faces, --max-levels, --max-json-depth; their help states the defaults,
/// which are those that `limits` has.
void add_container_limits(CLI::App& app, ContainerLimits& limits);

}  // namespace imgmesh
