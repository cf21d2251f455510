// The file of edits that imgmesh-warp reads: JSON as schemas/imgmesh-warp.edits.schema.json says.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "libcore/warp/warp_edits.h"

namespace imgmesh {

/// What read_edits refuses before it takes memory.
struct EditLimits {
    std::uint64_t max_bytes = std::uint64_t{16} << 20;
    int max_json_depth = 16;
};

/// Reads a file of edits. Every `where` is the path and a JSON pointer, as in "edits.json: /edits/0/pins/1".
///
/// Throws Error: kIo where the file cannot be read; kBadFile for what is too large, too deep, no JSON or not
/// as the schema says, in one line with the place: line and column, or a JSON pointer. Whether the levels and
/// vertices are there is for solve_edits() to say.
WarpEdits read_edits(const std::string& path, const EditLimits& limits = {});

/// As read_edits, of a text; `name` stands for the path.
WarpEdits edits_from_json(std::string_view text, const std::string& name, const EditLimits& limits = {});

}  // namespace imgmesh
