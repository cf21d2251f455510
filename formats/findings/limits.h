// Limits that a reader of containers checks before it takes memory.
#pragma once

#include <cstdint>

namespace imgmesh {

/// The defaults admit what this version can write on an ordinary machine.
struct ContainerLimits {
    std::uint64_t max_bytes = std::uint64_t{8} << 30;
    std::int64_t max_pixels = std::int64_t{1} << 28;
    std::int64_t max_faces = std::int64_t{1} << 28;
    int max_levels = 32;
    int max_json_depth = 64;
};

}  // namespace imgmesh
