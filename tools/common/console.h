// What the tools print.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace imgmesh {

/// Writes the whole text to a standard stream. Throws Error(kIo) if that does not take it.
void write_stream(int fd, const std::string& text);

/// Returns a report as JSON that is one line, or many with an indentation; with a line feed at the end.
std::string json_text(const nlohmann::ordered_json& report, bool one_line);

/// One line on standard error; `tool` as in "imgmesh-build".
void print_error(const std::string& tool, const std::string& message);
void print_warning(const std::string& tool, const std::string& message);

}  // namespace imgmesh
