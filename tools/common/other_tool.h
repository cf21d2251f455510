// Which tool writes what was asked of another one.
#pragma once

#include <string>

namespace imgmesh {

/// Returns "; imgmesh-convert writes .obj from a container", or alike, if another tool than `tool` writes
/// files of the extension of `path`; else "".
std::string other_tool(const std::string& tool, const std::string& path);

}  // namespace imgmesh
