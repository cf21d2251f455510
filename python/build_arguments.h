// The parameters of a build as Python's arguments.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <string_view>

#include "libcore/pipeline/build_params.h"

namespace imgmesh::python {

/// Returns the name of a parameter as an argument: that of param_table() with underscores.
std::string argument_name(std::string_view name);

/// Returns a parameter as it is given to build(), for advice in messages.
std::string argument_text(std::string_view name, std::string_view value);

/// Takes the parameters of param_table() and `preset` out of `arguments` and returns what they mean. A
/// TypeError names an argument of another type; Error(kBadArgument) is thrown for a value out of range and
/// for two arguments that exclude each other.
BuildParams take_build_params(pybind11::dict& arguments);

/// Returns all parameters of build() as dicts with name, group, help, default and, where it has some, words.
pybind11::list list_build_params();

}  // namespace imgmesh::python
