// Commands that people copy: the end of each tool's help, and of its manual.
#pragma once

#include <span>
#include <string>

namespace imgmesh {

struct Example {
    const char* command;
    const char* meaning;
};

/// Returns the examples of a tool; none for another name. tests/cli/help_test.py runs all of them.
std::span<const Example> examples_of(const std::string& tool);

}  // namespace imgmesh
