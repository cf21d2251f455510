// One finding in a file, and its place.
#pragma once

#include <cstdint>
#include <string>

#include "formats/findings/finding_codes.h"
#include "formats/findings/place.h"

namespace imgmesh {

/// One finding in one file.
struct Issue {
    const Finding* finding;  ///< of kFindings
    std::string text;        ///< one line: what was found
    Place place;             ///< the first of `count` places
    std::uint64_t count = 1;
};

}  // namespace imgmesh
