// --config FILE: options from a file.
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace imgmesh {

/// Adds --config FILE. The file is TOML: keys are long option names without dashes; values are strings,
/// numbers, true or false, and arrays of them for options that take a LIST or may be given several times.
/// Those above all tables are for every tool. Those in a table are for one tool, by its name after
/// "imgmesh-", count more than those above, and are not looked at by other tools. What the command line gives
/// counts more than the file, also against options that exclude what it gives.
///
/// Anything else is refused with Error(kBadArgument) and the line's number: text that is not TOML, an unknown
/// option or table, an option given twice, one that makes no sense in a file (help, version, config), a list
/// for an option that takes one value, a file of more than 1 MiB.
CLI::Option* add_config_option(CLI::App& app);

/// Returns "FILE:LINE: " if `message` begins with an option, as in "--preset 'bst': ...", whose value is from
/// that file; else "".
std::string place_in_config(const CLI::App& app, std::string_view message);

}  // namespace imgmesh
