// The options of imgmesh-build.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/pipeline/build_source.h"
#include "tools/common/compression_options.h"
#include "tools/common/texture_options.h"
#include "tools/tiles/tile_options.h"

namespace imgmesh {

struct BuildOptions {
    std::string input;
    std::string output;
    BuildParams params;  ///< what `preset` and then `given` make of it, when all options have been read
    BuildParams preset;
    std::vector<std::function<void(BuildParams&)>> given;  ///< the options that count more than the preset
    CompressionOptions compression;
    LayerLayout layers = LayerLayout::kExr;  ///< kOff with `no_map`
    bool no_map = false;
    ReadImageOptions read;
    AlphaParams alpha;
    std::string mask;
    TextureOptions texture;
    bool density = false;  ///< whether a density was asked for: it is not only the default
    bool strict = false;
    TileOptions tiles;
};

/// Adds every option, those of BuildParams from param_table(). They are checked together when all have been
/// read (build_contradictions.h).
void add_build_options(CLI::App& app, BuildOptions& options);

}  // namespace imgmesh
