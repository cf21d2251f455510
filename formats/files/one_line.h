// Puts messages of other libraries and names from files on one line.
#pragma once

#include <string>

namespace imgmesh {

/// Returns a library's message as one line without control characters.
std::string one_line(const std::string& message);

/// A name from a file, or a text with such names, as messages quote it: `instead` for each control character.
std::string printable(std::string text, char instead = '?');

}  // namespace imgmesh
