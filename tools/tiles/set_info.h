// What imgmesh-info says of tile sets.
#pragma once

#include <iosfwd>
#include <string>

#include "tools/common/tool_main.h"

namespace imgmesh {

/// Returns the facts of a set from its index alone.
Report set_facts(const std::string& path);
/// Prints them.
void print_set_facts(const Report& report, std::ostream& out);
/// Returns them in a few words.
std::string set_facts_line(const Report& report);

}  // namespace imgmesh
