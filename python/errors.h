// Errors and warnings as Python has them.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace imgmesh::python {

/// Issues each text as an imgmesh.Warning. Throws if the filters of Python's warnings make errors of them.
void warn(const std::vector<std::string>& texts);

/// Adds to `warnings` what was asked for and not reached, after the name of what it belongs to. Throws
/// Error(kUnsupported) instead if `strict`.
void tell_missed(const std::string& name, const std::vector<std::string>& missed, bool strict,
                 std::vector<std::string>& warnings);

}  // namespace imgmesh::python
