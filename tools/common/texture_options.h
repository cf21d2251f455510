// --texture, for the tools that write containers.
#pragma once

#include <optional>

#include "formats/picture/texture_file.h"
#include "tools/common/options.h"

namespace CLI {
class App;
}

namespace imgmesh {

struct TextureOptions {
    std::optional<bool> wanted;  ///< none: neither --texture nor --no-texture
    TextureType type = TextureType::kPng;
};

/// --texture, --no-texture if there may be a texture already, and --texture-type, which is refused without a
/// texture.
void add_texture_options(CLI::App& app, TextureOptions& options, const Help& help, bool removable);

}  // namespace imgmesh
