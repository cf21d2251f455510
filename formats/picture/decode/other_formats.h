// Names files that are no image that imgmesh reads.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace imgmesh {

/// Returns what the file is, why it is not read and what helps, as the rest of an error line; empty for
/// content of no known kind. `extension` is in lower case with its dot. It decides only where a content has
/// no signature.
std::string name_other_format(std::span<const std::uint8_t> bytes, const std::string& extension);

}  // namespace imgmesh
