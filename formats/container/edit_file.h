// The file of edits that imgmesh-warp reads: JSON under schemas/imgmesh-warp.edits.schema.json.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// Limits that read_edits() checks before it takes memory.
struct EditLimits {
    std::uint64_t max_bytes = std::uint64_t{16} << 20;
    int max_json_depth = 16;
};

/// Reads a file of edits. Every `where` is the path and a JSON pointer, as in "edits.json: /edits/0/pins/1".
///
/// Throws Error: kIo if the file cannot be read; kBadFile for content that is too large, too deep, not JSON,
/// or not as the schema says. The text is one line with the place: line and column, or a JSON pointer.
/// solve_edits() checks whether the levels and vertices exist.
WarpEdits read_edits(const std::string& path, const EditLimits& limits = {});

/// Like read_edits(), for a text; `name` replaces the path in messages.
WarpEdits edits_from_json(std::string_view text, const std::string& name, const EditLimits& limits = {});

}  // namespace imgmesh
