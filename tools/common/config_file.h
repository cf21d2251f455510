// --config FILE: options from a file.
#pragma once

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace imgmesh {

/// Adds --config FILE. The file is TOML without tables: keys are long option names without dashes; values are
/// strings, numbers, true or false, and arrays of them for options that take a LIST. What the command line
/// gives counts more.
///
/// Anything else is refused with Error(kBadArgument) and the line's number: text that is not TOML, an unknown
/// option, one given twice, one that makes no sense in a file (help, version, config), a table, a list for an
/// option that takes one value, a file of more than 1 MiB.
CLI::Option* add_config_option(CLI::App& app);

}  // namespace imgmesh
