// The options of imgmesh-build.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "formats/container/container.h"
#include "formats/picture/image_io.h"
#include "libcore/pipeline/build_params.h"
#include "tools/common/texture_options.h"

namespace imgmesh {

/// What an alpha channel is to a build.
enum class AlphaUse {
    kAuto,   ///< kept if it is soft, else cut
    kKeep,   ///< a channel of the mesh
    kCut,    ///< a mask
    kIgnore  ///< nothing
};

struct BuildOptions {
    std::vector<std::string> inputs;
    std::string output;
    BuildParams params;  ///< what `preset` and then `given` make of it, when all options have been read
    BuildParams preset;
    std::vector<std::function<void(BuildParams&)>> given;  ///< the options that count more than the preset
    DracoMode draco = DracoMode::kEdgebreaker;
    ReadImageOptions read;
    AlphaUse alpha = AlphaUse::kAuto;
    std::string mask;
    std::optional<double> alpha_threshold;  ///< none: 1/2, or where alpha is kept whatever is not transparent
    TextureOptions texture;
};

/// Adds every option, those of BuildParams from param_table(). They are checked together when all have been
/// read (build_contradictions.h).
void add_build_options(CLI::App& app, BuildOptions& options);

}  // namespace imgmesh
