// The parameters of a build as an object of JavaScript.
#pragma once

#include <emscripten/val.h>

#include <string>
#include <string_view>

#include "libcore/pipeline/build_params.h"

namespace imgmesh::web {

/// Returns a parameter as it is given to build(), for advice in messages: "map-smoothness: 3".
std::string argument_text(std::string_view name, std::string_view value);

/// Returns what the members of `arguments` mean: `preset`, and those of param_table() by their names. Members
/// that are undefined count as absent. Throws Error(kBadArgument) for a name that does not exist, a value of
/// another type or out of range, and two that exclude each other.
BuildParams build_params_from(const emscripten::val& arguments);

/// Returns all parameters as objects { name, group, help, default, words }.
emscripten::val list_build_params();

}  // namespace imgmesh::web
