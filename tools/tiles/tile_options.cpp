#include "tools/tiles/tile_options.h"

#include "libcore/tiles/tile_grid.h"
#include "tools/common/help.h"
#include "tools/common/options.h"

namespace imgmesh {

void add_tile_options(CLI::App& app, TileOptions& o) {
    const std::string group = "Tile set";
    CLI::Option* const tiles = in_group(
        add_count(app, "--tiles", o.size, {kLeastTile, kMostTile},
                  {"Make -o a folder with a tile set: tiles of so many pixels a side whose meshes meet, of a "
                   "picture of any size, with coarser levels and 3D Tiles. A run that was stopped goes on"}),
        group);
    CLI::Option* const plan = in_group(add_flag(
                                           app, "--plan", [&o] { o.plan = true; },
                                           "Only write the plan of a tile set, and print the names of its "
                                           "jobs; --json prints also what each "
                                           "needs, its command, its memory and its time"),
                                       group);
    CLI::Option* const job =
        in_group(add_value(app, "--job", "NAME",
                           [&o](const std::string& text) {
                               if (text.empty())
                                   throw Error(ErrorKind::kBadArgument, "--job '': expected a name");
                               o.job = text;
                           },
                           {"Do one job of a planned tile set, as in tile/0/3_5"}),
                 group);
    needs(plan, tiles);
    needs(job, tiles);
    exclude(app, job, {"--plan"});
    advanced(app, plan);
    advanced(app, job);
}

void check_tile_options(const CLI::App& app) {
    const auto refuse = [&](std::initializer_list<const char*> names, const char* why) {
        const std::string option = typed(app, names);
        if (!option.empty()) throw Error(ErrorKind::kBadArgument, cat(option, " and --tiles: ", why));
    };
    refuse({"--levels", "--level-faces", "--level-errors"}, "a tile set has levels of its own");
    refuse({"--rms"}, "an RMS is searched over several meshes of the whole picture");
    refuse({"--max-cluster"}, "its limit is searched over several meshes of the whole picture");
    refuse({"--no-map"}, "the tiles of level 0 have pixel maps, and those of view/ none");
    refuse({"--texture", "--texture-type"}, "tiles have no textures");
    refuse({"--visits"}, "tiles have none");
    refuse({"--skip-existing", "--force"}, "finished tiles of the same plan are always left alone");
}

}  // namespace imgmesh
