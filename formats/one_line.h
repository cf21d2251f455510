// Messages of other libraries.
#pragma once

#include <string>

namespace imgmesh {

/// A library's message as one line without control characters.
std::string one_line(const std::string& message);

}  // namespace imgmesh
