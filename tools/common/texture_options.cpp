#include "tools/common/texture_options.h"

#include "tools/common/options.h"

namespace imgmesh {

void add_texture_options(CLI::App& app, TextureOptions& options, const std::string& help, bool removable) {
    CLI::Option* const texture = app.add_flag_callback(
        "--texture", [&options] { options.wanted = true; }, help);
    if (removable)
        app.add_flag_callback(
               "--no-texture", [&options] { options.wanted = false; },
               "Leave the input's texture out; viewers then show the vertices' colours")
            ->excludes(texture);
    add_choice(app, "--texture-type", options.type,
               std::vector<std::pair<std::string, TextureType>>{{"png", TextureType::kPng},
                                                                {"jpeg", TextureType::kJpeg}},
               "Format of the texture: lossless, or smaller (default png)")
        ->needs(texture);
}

}  // namespace imgmesh
