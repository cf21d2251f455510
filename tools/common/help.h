// Help in two sizes: --help shows what people use every day, --help-all shows everything.
#pragma once

#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace imgmesh {

/// The heading of what all tools have.
inline constexpr const char* kGeneralGroup = "General";
/// That of limits, which decide whether there is a result, not which.
inline constexpr const char* kLimitsGroup = "Limits";

/// Makes `app` show its options in groups under headings, wrapped. Call it before adding
/// options.
void set_help_style(CLI::App& app);

/// Shows an option of `app` only in --help-all.
CLI::Option* advanced(CLI::App& app, CLI::Option* option);

/// Returns what --help prints.
std::string everyday_help(const CLI::App& app);
/// Returns what --help-all prints, from which manuals and completions are made.
std::string full_help(const CLI::App& app);

}  // namespace imgmesh
