// --config FILE: options from a file.
#pragma once

#include <CLI/CLI.hpp>

namespace imgmesh {

/// Adds --config FILE. The file holds lines `option = value` of TOML, without tables and arrays: keys are
/// long option names without dashes; values are strings, numbers, true or false; # starts a comment. What the
/// command line gives counts more.
///
/// Anything else is refused with Error(kBadArgument) and the line's number: an unknown option, one given
/// twice, one that makes no sense in a file (help, version, config), a line that is no `option = value`.
void add_config_option(CLI::App& app);

}  // namespace imgmesh
