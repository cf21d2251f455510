// Limits on the size of containers.
#pragma once

#include <cstdint>
#include <limits>

namespace imgmesh {

/// Readers refuse a larger container with Error(kBadFile) before they take memory for it. The defaults admit
/// what this version writes on a machine of ordinary size; who reads files of strangers sets lower ones.
struct ContainerLimits {
    std::uint64_t max_bytes = std::uint64_t{8} << 30;  ///< of all files together
    /// Of the image, once for each level. A level takes 12 bytes a pixel.
    std::int64_t max_pixels = std::int64_t{1} << 30;
    std::int64_t max_faces = std::int64_t{1} << 28;  ///< of each level
    int max_levels = 32;                             ///< of the pyramid
    int max_json_depth = 64;                         ///< of objects and arrays in each other
    /// Of the maps and meshes of all levels [bytes]. The files' own bytes and what is drawn come on top.
    std::uint64_t max_memory = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace imgmesh
