// Parses JSON of any origin, within limits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace imgmesh {

class Findings;

/// Throws FindingError for text that is too long, not JSON, not UTF-8, or nested deeper than `max_depth`. If
/// `findings` collects, it also reports duplicate members of an object (json.duplicate); the last one is
/// kept.
nlohmann::json parse_json(std::string_view text, int max_depth, Findings& findings);

}  // namespace imgmesh
