// The options that results depend on, for reports.
#pragma once

#include <nlohmann/json.hpp>

#include "tools/common/tool_main.h"

namespace CLI {
class App;
}

namespace imgmesh {

/// Returns the options of a parsed command line, without their dashes: what was given, or else the default,
/// or null where that depends on the file or is nothing. Numbers become numbers, and flags true or false.
/// What the results do not depend on is left out: outputs and the general options.
Report parameters_report(const Tool& tool, const CLI::App& app);

/// The same without limits, which decide whether there is a result, and with the SHA-256 of the files that
/// Tool::sources name. Null if one of them can be read only once.
Report journal_parameters(const Tool& tool, const CLI::App& app);

}  // namespace imgmesh
