// --texture, for the tools that write containers.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "formats/picture/texture_file.h"

namespace imgmesh {

struct TextureOptions {
    std::optional<bool> wanted;  ///< none: neither --texture nor --no-texture
    TextureType type = TextureType::kPng;
};

/// --texture, --no-texture where there may be one already, and --texture-type, which is refused without.
void add_texture_options(CLI::App& app, TextureOptions& options, const std::string& help, bool removable);

}  // namespace imgmesh
