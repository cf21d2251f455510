// What validate_container() returns: findings in a file.
#pragma once

#include <cstdint>
#include <string>

#include "formats/findings/finding_codes.h"
#include "formats/findings/place.h"

namespace imgmesh {

/// One finding in a file. A defect that occurs many times, such as at many pixels, is one issue.
struct Issue {
    const Finding* finding;   ///< its kind, a member of kFindings
    std::string text;         ///< what was found, in one line
    Place place;              ///< where it occurs first
    std::uint64_t count = 1;  ///< how often it occurs
};

}  // namespace imgmesh
