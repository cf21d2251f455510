#include "tools/common/texture_options.h"

#include "tools/common/help.h"
#include "tools/common/names.h"

namespace imgmesh {

void add_texture_options(CLI::App& app, TextureOptions& options, const Help& help, bool removable) {
    const std::string group = "Container", text = help.otherwise.empty()
                                                      ? help.text
                                                      : cat(help.text, " (default ", help.otherwise, ")");
    CLI::Option* const texture = in_group(add_flag(
                                              app, "--texture", [&options] { options.wanted = true; }, text),
                                          group);
    if (removable) {
        CLI::Option* const none = add_flag(
            app, "--no-texture", [&options] { options.wanted = false; },
            "Leave the input's texture out; viewers then show the vertices' colours");
        exclude(app, in_group(none, group), {"--texture"});
    }
    CLI::Option* const type = add_choice(app, "--texture-type", options.type, texture_type_choices(),
                                         "Format of the texture, lossless or smaller");
    advanced(app, in_group(needs(type, texture), group));
}

}  // namespace imgmesh
