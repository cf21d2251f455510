// Parses JSON of any origin, within limits.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string_view>

namespace imgmesh {

class Findings;

struct JsonLimits {
    int max_depth = 64;  ///< of objects and arrays in each other
    /// Objects, arrays, strings, numbers and other values. Libraries take up to 0.9 kB for each.
    std::size_t max_values = std::size_t{1} << 18;
};

/// Throws FindingError for text that is too long, not JSON, not UTF-8, or over the limits, before memory is
/// taken for its values. If `findings` collects, it also reports duplicate members of an object
/// (json.duplicate); the last one is kept. Takes time in proportion to the text.
nlohmann::json parse_json(std::string_view text, const JsonLimits& limits, Findings& findings);

}  // namespace imgmesh
