// Help in two sizes: --help shows what people use every day, --help-all shows everything.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace imgmesh {

/// Gives `app` its way of showing options, in groups under headings, wrapped. Call it before any option is
/// added.
void set_help_style(CLI::App& app);

/// Leaves an option of `app` to --help-all.
CLI::Option* advanced(CLI::App& app, CLI::Option* option);

/// What --help prints.
std::string everyday_help(const CLI::App& app);
/// What --help-all prints, and manuals and completions are made from.
std::string full_help(const CLI::App& app);

}  // namespace imgmesh
