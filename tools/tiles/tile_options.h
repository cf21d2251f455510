// The options of imgmesh-build for tile sets.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace imgmesh {

struct TileOptions {
    std::optional<int> size;  ///< of --tiles; none: one container
    bool plan = false;
    std::string job;
    std::vector<std::string> command;  ///< the program and its arguments, as they were given
};

void add_tile_options(CLI::App& app, TileOptions& options);

/// Throws Error(kBadArgument) for options that mean nothing for tile sets, as they were typed.
void check_tile_options(const CLI::App& app);

}  // namespace imgmesh
