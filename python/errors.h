// Errors and warnings as Python has them.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace imgmesh::python {

/// Issues each text as an imgmesh.Warning. Throws if the filters of Python's warnings make errors of them.
void warn(const std::vector<std::string>& texts);

}  // namespace imgmesh::python
