// JSON of any origin as a document, within limits.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace imgmesh {

class Findings;

/// Throws FindingError for text that is too long, no JSON, no UTF-8, or nested deeper than `max_depth`. Where
/// `findings` collects, it tells of members that an object has twice (json.duplicate), of which the last
/// stays.
nlohmann::json parse_json(std::string_view text, int max_depth, Findings& findings);

}  // namespace imgmesh
