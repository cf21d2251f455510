#include "tools/common/limits.h"

#include <limits>

#include "tools/common/help.h"
#include "tools/common/options.h"

namespace imgmesh {

void add_container_limits(CLI::App& app, ContainerLimits& limits) {
    const auto add = [&](const char* name, auto& target, std::int64_t most, const char* help) {
        advanced(app, in_group(add_count(app, name, target, {1, most}, help), kLimitsGroup));
    };
    const std::int64_t any = std::numeric_limits<std::int64_t>::max();
    add("--max-bytes", limits.max_bytes, any, "Refuse a container of more bytes, all files together");
    add("--max-pixels", limits.max_pixels, any, "Refuse more pixels, counted once for each level");
    add("--max-faces", limits.max_faces, any, "Refuse a mesh of more faces");
    add("--max-levels", limits.max_levels, 1000, "Refuse more levels");
    // The parser's result is destroyed level by level on the stack.
    add("--max-json-depth", limits.max_json_depth, 1000, "Refuse JSON that is nested deeper");
}

ContainerLimits container_limits(ContainerLimits limits, std::uint64_t max_memory) {
    limits.max_memory = max_memory;
    return limits;
}

ReadImageOptions image_options(ReadImageOptions read, const ContainerLimits& limits,
                               std::uint64_t max_memory) {
    if (limits.max_pixels != ContainerLimits().max_pixels) {
        read.limits.max_pixels = limits.max_pixels;
        read.limits.max_pixels_per_byte = 0;
    }
    read.limits.max_memory = max_memory;
    return read;
}

}  // namespace imgmesh
