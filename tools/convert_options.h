// The options of imgmesh-convert.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/mesh/outline_mesh.h"
#include "libcore/pipeline/build_params.h"
#include "tools/common/compression_options.h"
#include "tools/common/texture_options.h"
#include "tools/convert_level.h"

namespace imgmesh {

struct ConvertOptions {
    std::string input;
    std::string output;
    CompressionOptions compression;
    std::vector<int> levels;
    bool no_map = false;
    MeshPrecision precision = MeshPrecision::kExact;
    TextureOptions texture;
    std::optional<int> level;
    std::optional<ExportKind> as;
    std::optional<Shading> shading;
    std::optional<double> outline_tolerance;
    OutlineSide outline_side = OutlineSide::kOut;
    std::string image;
    ReadImageOptions read;
    ContainerLimits limits;
};

void add_convert_options(CLI::App& app, ConvertOptions& options);

/// Returns those of the export of a level.
LevelOptions level_options(const ConvertOptions& options);

/// Throws Error(kBadArgument) for mistakes that can be found before the container is read.
void check_convert_options(const ConvertOptions& options);

}  // namespace imgmesh
