// What is wrong with a command line, in the words of its user.
#pragma once

#include <string>

namespace CLI {
class App;
}

namespace imgmesh {

/// Returns the error line for what `app` could not parse: an unknown option with the one that was probably
/// meant, or else `what`, the parser's own words.
std::string usage_error(const CLI::App& app, const std::string& what);

}  // namespace imgmesh
