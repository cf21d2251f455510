// --draco, --compression and --layers, for the tools that write containers.
#pragma once

#include <optional>

#include "formats/container/container.h"
#include "tools/common/options.h"

namespace imgmesh {

enum class Compression { kDraco, kMeshopt, kOff };

struct CompressionOptions {
    std::optional<DracoMode> draco;
    std::optional<Compression> method;
    std::optional<LayerLayout> layers;  ///< not kOff

    bool given() const { return draco || method; }
};

/// --draco, which is refused with --compression, and --layers.
///
/// otherwise, layers_otherwise  what a container has without them, in words
void add_compression_options(CLI::App& app, CompressionOptions& options, const std::string& otherwise,
                             const std::string& layers_otherwise);

/// Throws Error(kBadArgument) where meshopt is asked for containers, which imgmesh could not read, and where
/// layers are asked for without a map.
void check_compression(const CompressionOptions& options, bool with_map);

/// Sets how `container` is compressed; `otherwise` is how without an option.
void compress(ContainerOptions& container, const CompressionOptions& options, DracoMode otherwise);

}  // namespace imgmesh
