// Options for the limits that a reader checks before it takes memory.
#pragma once

#include <cstdint>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// --max-bytes, --max-pixels, --max-faces, --max-levels, --max-json-depth; their help states the defaults,
/// which are those that `limits` has.
void add_container_limits(CLI::App& app, ContainerLimits& limits);

/// Returns the limits of a container that is read with `max_memory` [bytes].
ContainerLimits container_limits(ContainerLimits limits, std::uint64_t max_memory);

/// Returns how to read an image beside a container, in a tool whose --max-pixels is for both; if it is not
/// given, each has its own default.
ReadImageOptions image_options(ReadImageOptions read, const ContainerLimits& limits,
                               std::uint64_t max_memory);

}  // namespace imgmesh
